#include "io/files.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <fstream>
#include <thread>

namespace pfvox::io {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            fs::path(testing::TempDir()) / ("pfvox-files-" + std::to_string(::getpid()) + "-" +
                                            testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::span<const std::byte> bytesOf(std::string_view text) {
        return std::as_bytes(std::span(text));
    }
    static std::string contentOf(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }

    std::vector<std::string> namesInFolder() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_))
            names.push_back(entry.path().filename().string());
        return names;
    }
    static mode_t modeOf(const fs::path& file) {
        struct stat info {};
        EXPECT_EQ(::stat(file.c_str(), &info), 0);
        return info.st_mode & 07777u;
    }

    fs::path folder_;
};

/// From here on this process has no unnamed files, as on file systems that do not know them.
void forbidUnnamedFiles() {
    std::array<sock_filter, 6> program{{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_TMPFILE & ~O_DIRECTORY, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    }};
    const sock_fprog filter{.len = program.size(), .filter = program.data()};
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
        ::_exit(99);
}

TEST_F(Files, WhatIsWrittenIsRead) {
    const fs::path file = folder_ / "a b" / "ü.bin";
    ASSERT_TRUE(writeFileAtomically(file, bytesOf("first")));
    ASSERT_TRUE(writeFileAtomically(file, bytesOf("second, longer")));
    const auto read = readFile(file, 1000);
    ASSERT_TRUE(read);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(read->bytes().data()), read->bytes().size()),
              "second, longer");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "a b"), fs::directory_iterator{}), 1);
}

TEST_F(Files, AtomicFileIsInPlaceOnlyAfterItsCommit) {
    const fs::path file = folder_ / "asset";
    ASSERT_TRUE(writeFileAtomically(file, bytesOf("old")));
    {
        auto pending = AtomicFile::createWith(file, bytesOf("new"));
        ASSERT_TRUE(pending);
        EXPECT_EQ(contentOf(file), "old");
        AtomicFile moved = *std::move(pending);
        ASSERT_TRUE(moved.commit());
        EXPECT_EQ(contentOf(file), "new");
    }
    { const auto dropped = AtomicFile::createWith(file, bytesOf("never")); }
    EXPECT_EQ(contentOf(file), "new");
    EXPECT_EQ(filesInFolder(), 1u) << "no temporary file stays";
}

TEST_F(Files, EmptyFileIsReadAsNoBytes) {
    ASSERT_TRUE(writeFileAtomically(folder_ / "empty", {}));
    EXPECT_TRUE(readFile(folder_ / "empty", 10)->bytes().empty());
}

TEST_F(Files, FailuresNameTheFileAndTheReason) {
    const auto missing = readFile(folder_ / "no.vox", 10);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::FileNotFound);
    EXPECT_EQ(missing.error().file, folder_ / "no.vox");
    EXPECT_THAT(missing.error().message, testing::HasSubstr("No such file"));

    EXPECT_EQ(readFile(folder_, 10).error().code, ErrorCode::FileNotReadable);

    ASSERT_TRUE(writeFileAtomically(folder_ / "large", bytesOf("0123456789a")));
    const auto large = readFile(folder_ / "large", 10);
    EXPECT_EQ(large.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(large.error().message, testing::HasSubstr("maxFileBytes"));
}

TEST_F(Files, PipesWithoutWriterAndDevicesAreRefusedInsteadOfReadForever) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(readFile(pipe, 10).error().code, ErrorCode::FileNotReadable);
    EXPECT_THAT(readFile(pipe, 10).error().message, testing::HasSubstr("start what writes into it"));
    EXPECT_EQ(readFile("/dev/zero", 10).error().code, ErrorCode::FileNotReadable);
}

TEST_F(Files, APipeIsReadUntilItsWriterIsDone) {
    const auto readBack = [](const std::string& text, std::uint64_t most) {
        std::array<int, 2> ends{};
        EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
        const std::jthread writer([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the reader waits first
            for (std::size_t at = 0; at < text.size();) {
                const ssize_t n = ::write(ends[1], text.data() + at, text.size() - at);
                if (n < 0) break;
                at += static_cast<std::size_t>(n);
            }
            ::close(ends[1]);
        });
        auto bytes = readFile("/dev/fd/" + std::to_string(ends[0]), most);
        ::close(ends[0]);
        return bytes;
    };
    const std::string more(3'000'000, 'x');  // than a pipe and the first buffer hold
    const auto bytes = readBack(more, more.size());
    ASSERT_TRUE(bytes) << describe(bytes.error());
    EXPECT_TRUE(std::ranges::equal(bytes->bytes(), bytesOf(more)));
    EXPECT_EQ(readBack("0123456789a", 10).error().code, ErrorCode::LimitExceeded);
}

TEST(PathFromText, refusesWhatTheSystemWouldCutOff) {
    EXPECT_EQ(pathFromText("a b/ü\n.vox")->string(), "a b/ü\n.vox");
    EXPECT_EQ(pathFromText("").error().code, ErrorCode::BadValue);
    const auto cut = pathFromText(std::string_view("one.vox\0two.vox", 15));
    ASSERT_FALSE(cut);
    EXPECT_THAT(cut.error().message, testing::HasSubstr("after 7 bytes"));
}

TEST_F(Files, ALinkStaysALinkAndWhatItLeadsToIsReplaced) {
    fs::create_directories(folder_ / "disk");
    ASSERT_TRUE(writeFileAtomically(folder_ / "disk" / "asset", bytesOf("old")));
    fs::create_symlink("disk/asset", folder_ / "link");
    fs::create_symlink("disk/later", folder_ / "dangling");
    ASSERT_TRUE(writeFileAtomically(folder_ / "link", bytesOf("new")));
    ASSERT_TRUE(writeFileAtomically(folder_ / "dangling", bytesOf("first")));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "dangling"));
    EXPECT_EQ(contentOf(folder_ / "disk" / "asset"), "new");
    EXPECT_EQ(contentOf(folder_ / "disk" / "later"), "first");
    EXPECT_EQ(filesInFolder(), 3u);
}

TEST_F(Files, APipeIsWrittenToAndStaysAPipe) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int reader = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reader, 0);
    EXPECT_TRUE(writeFileAtomically(pipe, bytesOf("bytes")));
    std::array<char, 16> got{};
    EXPECT_EQ(::read(reader, got.data(), got.size()), 5);
    EXPECT_STREQ(got.data(), "bytes");
    ::close(reader);
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(Files, FailedWriteLeavesTheOldFileAndNothingElse) {
    ASSERT_TRUE(writeFileAtomically(folder_ / "plain", bytesOf("old")));
    const auto below = writeFileAtomically(folder_ / "plain" / "below.bin", bytesOf("new"));
    ASSERT_FALSE(below);
    EXPECT_EQ(below.error().code, ErrorCode::FileNotWritable);
    EXPECT_EQ(contentOf(folder_ / "plain"), "old");

    fs::create_directory(folder_ / "folder");
    EXPECT_EQ(writeFileAtomically(folder_ / "folder", bytesOf("new")).error().code,
              ErrorCode::FileNotWritable);
    EXPECT_EQ(filesInFolder(), 2u);
}

TEST_F(Files, WriteThatHitsALimitLeavesTheOldFileAndNothingElse) {
    // A file size limit of the process stands for a full disk: the write fails behind the open.
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("old")));
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    rlimit tight = before;
    tight.rlim_cur = 8;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
    const auto written = writeFileAtomically(folder_ / "asset", bytesOf("more than eight bytes"));
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::FileNotWritable);
    EXPECT_EQ(contentOf(folder_ / "asset"), "old");
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(Files, AnUnfinishedOutputHasNoNameOrOneThatIsRecognized) {
    const auto pending = AtomicFile::createWith(folder_ / "asset", bytesOf("new"));
    ASSERT_TRUE(pending);
    EXPECT_THAT(namesInFolder(), testing::Each(testing::MatchesRegex("\\.pfvox-[0-9a-f]+\\.tmp")));
}

TEST_F(Files, WhatDeadWritersLeftIsRemovedWhatLivingOnesHaveStays) {
    const fs::path dead = folder_ / ".pfvox-0123456789abcdef.tmp";
    const fs::path living = folder_ / ".pfvox-fedcba9876543210.tmp";
    const fs::path foreign = folder_ / ".pfvox-notes.tmp";
    for (const fs::path& file : {dead, living, foreign}) std::ofstream(file) << "bytes";
    const int writer = ::open(living.c_str(), O_WRONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(writer, LOCK_EX | LOCK_NB), 0);
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("new")));
    ::close(writer);
    EXPECT_THAT(namesInFolder(),
                testing::UnorderedElementsAre("asset", ".pfvox-fedcba9876543210.tmp", ".pfvox-notes.tmp"));
}

TEST_F(Files, WithoutUnnamedFilesOutputsAreCompleteOrNotThereToo) {
    const auto child = [&] {
        forbidUnnamedFiles();
        bool good = writeFileAtomically(folder_ / "asset", bytesOf("old")).has_value();
        {
            auto pending = AtomicFile::createWith(folder_ / "asset", bytesOf("new"));
            good = good && pending && filesInFolder() == 2 && contentOf(folder_ / "asset") == "old";
        }
        good = good && filesInFolder() == 1;
        good = good && writeFileAtomically(folder_ / "asset", bytesOf("new")).has_value();
        auto abandoned = AtomicFile::createWith(folder_ / "asset", bytesOf("never"));
        good = good && abandoned && filesInFolder() == 2;
        abandonOutputs();
        good = good && filesInFolder() == 1 && contentOf(folder_ / "asset") == "new";
        ::_exit(good ? 0 : 1);
    };
    EXPECT_EXIT(child(), testing::ExitedWithCode(0), "");
}

TEST_F(Files, AKilledWriterLeavesNothingThatTheNextOneDoesNotRemove) {
    const auto killed = [&] {
        forbidUnnamedFiles();
        const auto pending = AtomicFile::createWith(folder_ / "asset", bytesOf("half"));
        ::raise(SIGKILL);
    };
    EXPECT_EXIT(killed(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EQ(filesInFolder(), 1u);
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("whole")));
    EXPECT_THAT(namesInFolder(), testing::ElementsAre("asset"));
}

TEST_F(Files, AReplacedFilePassesOnItsPermissionsAndNewOnesFollowTheUmask) {
    const mode_t before = ::umask(0027);
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("old")));
    EXPECT_EQ(modeOf(folder_ / "asset"), 0640u);
    fs::permissions(folder_ / "asset", fs::perms(0664));
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("new")));
    ::umask(before);
    EXPECT_EQ(modeOf(folder_ / "asset"), 0664u);
}

TEST_F(Files, AReplacedFileKeepsItsOwnerWherePermitted) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("old")));
    ASSERT_EQ(::chown((folder_ / "asset").c_str(), 1234, 2345), 0);
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("new")));
    struct stat info {};
    ASSERT_EQ(::stat((folder_ / "asset").c_str(), &info), 0);
    EXPECT_EQ(info.st_uid, 1234u);
    EXPECT_EQ(info.st_gid, 2345u);
}

TEST_F(Files, AReadOnlyFileIsReplacedOnlyOnRequest) {
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("old")));
    fs::permissions(folder_ / "asset", fs::perms(0444));
    const auto refused = writeFileAtomically(folder_ / "asset", bytesOf("new"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::FileNotWritable);
    EXPECT_THAT(refused.error().message, testing::HasSubstr("chmod"));
    EXPECT_FALSE(checkReplaceable(folder_ / "asset"));
    EXPECT_EQ(contentOf(folder_ / "asset"), "old");
    ASSERT_TRUE(writeFileAtomically(folder_ / "asset", bytesOf("new"), {.replaceReadOnly = true}));
    EXPECT_EQ(contentOf(folder_ / "asset"), "new");
    EXPECT_EQ(modeOf(folder_ / "asset"), 0444u);
}

TEST_F(Files, NamesAreAsLongAsTheFileSystemTakesThem) {
    const fs::path file = folder_ / std::string(255, 'x');
    ASSERT_TRUE(writeFileAtomically(file, bytesOf("old")));
    ASSERT_TRUE(writeFileAtomically(file, bytesOf("new")));
    EXPECT_EQ(contentOf(file), "new");
}

}  // namespace
}  // namespace pfvox::io
