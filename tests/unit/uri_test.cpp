#include "scene/gltf/uri.h"

#include <string>

#include <gtest/gtest.h>

#include "support/files/files.h"
#include "support/files/temporary_folder.h"

namespace vkcppm {
namespace {

std::string decoded(std::string_view uri) {
    const auto bytes = decode_data_uri(uri);
    return bytes ? std::string(bytes->begin(), bytes->end()) : "(malformed)";
}

TEST(DecodeDataUri, ReadsTheVectorsOfRfc4648) {
    EXPECT_EQ(decoded("data:application/octet-stream;base64,"), "");
    EXPECT_EQ(decoded("data:application/octet-stream;base64,Zg=="), "f");
    EXPECT_EQ(decoded("data:application/gltf-buffer;base64,Zm8="), "fo");
    EXPECT_EQ(decoded("data:;base64,Zm9v"), "foo");
    EXPECT_EQ(decoded("data:text/plain;base64,Zm9vYmE="), "fooba");
    EXPECT_EQ(decoded("data:any/thing;base64,+/+/"), "\xfb\xff\xbf");
    EXPECT_EQ(decoded("data:any/thing;base64,-_-_"), "\xfb\xff\xbf") << "section 5";
}

TEST(DecodeDataUri, ReadsPercentEncodedData) {
    EXPECT_EQ(decoded("data:text/plain,a%20b"), "a b");
    EXPECT_EQ(decoded("data:text/plain,a%2"), "a%2") << "no escape";
    EXPECT_EQ(decoded("data:;base64,%2B%2f+%2F"), "\xfb\xff\xbf") << "escaped base64";
    EXPECT_EQ(decoded("data:;base64,Zg%3D%3D"), "f");
}

TEST(DecodeDataUri, TakesWhatBrowsersTake) {
    EXPECT_EQ(decoded("DATA:image/png;BASE64,Zm9v"), "foo");
    EXPECT_EQ(decoded("data:image/png;charset=utf-8;base64, Zm\r\n9v\tYg =\n="), "foob");
    EXPECT_TRUE(is_data_uri("Data:,"));
    EXPECT_FALSE(is_data_uri("dat"));
    EXPECT_FALSE(is_data_uri("data"));
}

TEST(DecodeDataUri, RefusesWhatIsMalformed) {
    EXPECT_EQ(decoded("data:;base64,Zm9v!"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64,Z"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64,Zm=v"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64"), "(malformed)");
}

TEST(ResolveUri, TakesRelativePathsAlone) {
    EXPECT_EQ(resolve_uri("/scenes", "a.bin"), "/scenes/a.bin");
    EXPECT_EQ(resolve_uri("/scenes", "sub/Box%20With%20Spaces.bin"), "/scenes/sub/Box With Spaces.bin");
    EXPECT_EQ(resolve_uri("/scenes", "sub/../a.bin"), "/scenes/a.bin");
    EXPECT_EQ(resolve_uri("/scenes", "../textures/a.png"), "/scenes/../textures/a.png");
    EXPECT_EQ(resolve_uri("/scenes", "textures\\a.png"), "/scenes/textures/a.png");
    EXPECT_EQ(resolve_uri("/scenes", "100%.png"), "/scenes/100%.png");
    EXPECT_EQ(resolve_uri("/scenes", "a%zz%20%2"), "/scenes/a%zz %2");
    for (const char* uri : {"/etc/passwd", "%2Fetc/passwd", "\\etc\\passwd", "", "C:\\a.png", "file:///a.bin",
                            "http://example.com/a.bin", "a%00.bin"}) {
        EXPECT_EQ(resolve_uri("/scenes", uri), std::nullopt) << uri;
    }
}

TEST(ResolveUri, FindsAFileThatIsCalledAsTheUriIsWritten) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a%20b.bin", "x");
    EXPECT_EQ(resolve_uri(folder.path(), "a%20b.bin"), folder / "a%20b.bin");
    test::write_bytes(folder / "a b.bin", "x");
    EXPECT_EQ(resolve_uri(folder.path(), "a%20b.bin"), folder / "a b.bin") << "what it means comes first";
    EXPECT_EQ(resolve_uri(folder.path(), "%2Fetc/passwd"), std::nullopt);
}

}  // namespace
}  // namespace vkcppm
