#include "support/scenes/loading.h"

#include "support/thrown.h"

namespace vkcppm::test {

void expect_bad_scene(const std::string& bytes, const std::vector<std::string>& parts) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "hostile.gltf";
    write_bytes(file, bytes);
    const auto error = thrown_by([&] { load_gltf(file); });
    ASSERT_TRUE(error) << "the file was accepted";
    const std::string message = error->what();
    EXPECT_EQ(error->code(), ExitCode::bad_input) << message;
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << part << " not in: " << message;
    }
}

}  // namespace vkcppm::test
