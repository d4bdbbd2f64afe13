// pfview as a program, run in a folder of its own: arguments in, exit code, stdout, stderr and files out.
#pragma once

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <pfvox/pf_vox.hpp>
#include <sstream>

#include "support/procedural.hpp"

namespace pfvox::test {

struct Outcome {
    int exitCode = -1;
    std::string out;
    std::string err;
};

inline std::string contentOf(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

class PfviewCli : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* const info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::path(PFVOX_TEST_OUTPUT_DIR) / (std::string("pfview-") + info->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    /// Runs in the test's own folder; arguments as a shell reads them. Leaks are those of the driver
    /// (support/driver_leaks.cpp); the same code is checked for its own in the other tests.
    Outcome run(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() +
                                    "' && ASAN_OPTIONS=detect_leaks=0 '" PFVOX_PFVIEW "' " + arguments +
                                    " > out 2> err";
        const int status = std::system(command.c_str());
        return {.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                .out = contentOf(folder_ / "out"),
                .err = contentOf(folder_ / "err")};
    }

    void writeRoom(const std::string& name) const {
        const auto bytes = encodePfVox(build(demoRoom()), EncodeSettings{});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        write(name, {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    }
    void write(const std::string& name, const std::string& content) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }

    std::filesystem::path folder_;
};

}  // namespace pfvox::test
