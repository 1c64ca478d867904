#include "scene/gltf/uri.h"

#include <string>

#include <gtest/gtest.h>

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
}

TEST(DecodeDataUri, ReadsPercentEncodedData) { EXPECT_EQ(decoded("data:text/plain,a%20b"), "a b"); }

TEST(DecodeDataUri, RefusesWhatIsMalformed) {
    EXPECT_EQ(decoded("data:;base64,Zm9v!"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64,Z"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64,Zm=v"), "(malformed)");
    EXPECT_EQ(decoded("data:;base64"), "(malformed)");
    EXPECT_EQ(decoded("data:text/plain,a%2"), "(malformed)");
}

TEST(ResolveUri, TakesRelativePathsAlone) {
    EXPECT_EQ(resolve_uri("/scenes", "a.bin"), "/scenes/a.bin");
    EXPECT_EQ(resolve_uri("/scenes", "sub/Box%20With%20Spaces.bin"), "/scenes/sub/Box With Spaces.bin");
    EXPECT_EQ(resolve_uri("/scenes", "sub/../a.bin"), "/scenes/a.bin");
    EXPECT_EQ(resolve_uri("/scenes", "../textures/a.png"), "/scenes/../textures/a.png");
    for (const char* uri : {"/etc/passwd", "%2Fetc/passwd", "", "file:///a.bin", "http://example.com/a.bin", "a%00.bin",
                            "a%zz.bin", "a%2"}) {
        EXPECT_EQ(resolve_uri("/scenes", uri), std::nullopt) << uri;
    }
}

}  // namespace
}  // namespace vkcppm
