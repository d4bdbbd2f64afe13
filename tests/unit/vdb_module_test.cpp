// The module that knows OpenVDB: found, refused and missed (docs/decisions/010-vdb-module.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "support/temp_folder.hpp"
#include "vdb_module/module_loader.hpp"

namespace pfvox::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// What opening the module in these folders says.
std::string refusal(const std::vector<fs::path>& folders) {
    const auto module = openVdbModule(folders);
    if (module) return "";
    EXPECT_EQ(module.error().code, ErrorCode::UnsupportedFeature);
    return module.error().message;
}

TEST(VdbModule, IsFoundInTheTreeOfTheProgramAndOpenedOnce) {
    const auto first = vdbModule();
    ASSERT_TRUE(first) << first.error().message;
    Result<const VdbModule*> second;
    std::thread([&] { second = vdbModule(); }).join();
    EXPECT_EQ(*first, *second);
}

TEST(VdbModule, MissingOneIsNamedWithEveryPlaceAndTheRemedy) {
    const TempFolder one;
    const TempFolder two;
    const std::string message = refusal({one.path(), two.path()});
    EXPECT_THAT(message, HasSubstr(one.path().string()));
    EXPECT_THAT(message, HasSubstr(two.path().string()));
    EXPECT_THAT(message, HasSubstr("install"));
}

TEST(VdbModule, OneOfAnotherBuildIsRefused) {
    const std::string message = refusal({PFVOX_MODULE_OF_ANOTHER_BUILD});
    EXPECT_THAT(message, HasSubstr("another build"));
    EXPECT_THAT(message, HasSubstr("0.0.0-fake"));
}

TEST(VdbModule, LibraryThatIsNoModuleIsRefused) {
    EXPECT_THAT(refusal({PFVOX_NO_MODULE}), HasSubstr("no module of pfvox"));
}

TEST(VdbModule, FileThatIsNoLibraryIsRefused) {
    const TempFolder folder;
    std::ofstream(folder / "pfvox_vdb.so") << "not a library";
    EXPECT_THAT(refusal({folder.path()}), HasSubstr("pfvox_vdb.so"));
}

#ifndef PFVOX_ADDRESS_SANITIZER
/// Opens the module with as much address space as this process has already.
[[noreturn]] void openWithoutMemory() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = (pages + 64) * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    ::setrlimit(RLIMIT_AS, &limit);
    const auto module = openVdbModule(moduleFolders());
    ::_exit(!module && module.error().code == ErrorCode::LimitExceeded ? 0 : 1);
}

TEST(VdbModule, TooLittleMemoryIsNotAMissingLibrary) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process that has not opened it
    EXPECT_EXIT(openWithoutMemory(), testing::ExitedWithCode(0), "");
}
#endif

TEST(VdbModule, FirstFolderThatHasItDecides) {
    const TempFolder empty;
    EXPECT_THAT(refusal({empty.path(), PFVOX_MODULE_OF_ANOTHER_BUILD}), HasSubstr("another build"));
}

}  // namespace
}  // namespace pfvox::test
