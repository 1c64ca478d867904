#include "app/page/base64.h"

#include <string>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

TEST(Base64, HasTheVectorsOfRfc4648) {
    EXPECT_EQ(encode_base64(""), "");
    EXPECT_EQ(encode_base64("f"), "Zg==");
    EXPECT_EQ(encode_base64("fo"), "Zm8=");
    EXPECT_EQ(encode_base64("foo"), "Zm9v");
    EXPECT_EQ(encode_base64("foob"), "Zm9vYg==");
    EXPECT_EQ(encode_base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(encode_base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(encode_base64(std::string("\xff\x00\xfb\xf0", 4)), "/wD78A==") << "bytes above 127 and zeros";
}

}  // namespace
}  // namespace vkcppm
