// What the tools share, tested without a process: patterns, suggestions, quantities, exit codes, batches.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <pfvox/text_encoding.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "common/batch.hpp"
#include "common/command_line.hpp"
#include "common/depfile.hpp"
#include "common/exit_code.hpp"
#include "common/interrupt.hpp"
#include "common/paths.hpp"
#include "common/program.hpp"
#include "common/table.hpp"
#include "common/text.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::tools {

TEST(Glob, starsStayInAFolderAndDoubleStarsDoNot) {
    EXPECT_TRUE(globMatches("*.vox", "a/b/c.vox")) << "a pattern without '/' is about the file name";
    EXPECT_TRUE(globMatches("a/*/c.vox", "a/b/c.vox"));
    EXPECT_FALSE(globMatches("a/*.vox", "a/b/c.vox"));
    EXPECT_TRUE(globMatches("a/**", "a/b/c.vox"));
    EXPECT_TRUE(globMatches("a/**/c.vox", "a/c.vox"));
    EXPECT_TRUE(globMatches("**/c.vox", "c.vox"));
    EXPECT_TRUE(globMatches("?.vox", "c.vox"));
    EXPECT_FALSE(globMatches("a?c.vox/x", "a/c.vox/x"));
    EXPECT_FALSE(globMatches("c.vo", "c.vox"));
    EXPECT_FALSE(globMatches("", "c.vox"));
}

// Tried one after the other, the stars of this one took minutes.
TEST(Glob, manyStarsTakeNoTime) {
    const std::string text(5000, 'a');
    std::string pattern;
    for (int i = 0; i < 300; ++i) pattern += i % 2 == 0 ? "*a" : "**a";
    EXPECT_TRUE(globMatches(pattern, text));
    EXPECT_FALSE(globMatches(pattern + "b", text));
    EXPECT_TRUE(globMatches("**/**/a/***", "x/y/a/b/c"));
    EXPECT_FALSE(globMatches("**/**/b", "x/ab"));
    EXPECT_TRUE(globMatches("a**/b", "ab"));
    EXPECT_TRUE(globMatches("a**/b", "ax/y/b"));
}

TEST(Escaped, leavesWordsAndShowsTheRest) {
    EXPECT_EQ(escaped("Fenêtre 房子 🏠 a\"b\\c"), "Fenêtre 房子 🏠 a\"b\\c");
    EXPECT_EQ(escaped("\x1b[31mred\x07\x7f"), "\\x1b[31mred\\x07\\x7f");
    EXPECT_EQ(escaped("one\ntwo\r\tthree"), "one\\ntwo\\x0d\\x09three");
    EXPECT_EQ(escaped(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(escaped("\xc2\x9b"
                      "31m\xe2\x80\xae"
                      "txt"),
              "\\u{9b}31m\\u{202e}txt")
        << "C1 codes and turned text";
    EXPECT_EQ(escaped("Fen\xeatre \xc0\xaf \xed\xa0\x80"), "Fen\\xeatre \\xc0\\xaf \\xed\\xa0\\x80")
        << "no UTF-8";
}

TEST(SafeFileNames, differForNamesThatDiffer) {
    const std::vector<std::string> names{"房间",
                                         "厨房",
                                         "hall, east",
                                         "hall 1",
                                         "hall_1",
                                         "Hall_1",
                                         "hall 1",
                                         "..",
                                         "a/b",
                                         "",
                                         "a\nb",
                                         "a_b",
                                         std::string(300, 'n'),
                                         std::string(301, 'n'),
                                         "b\xff",
                                         "con:x"};
    const std::vector<std::string> safe = safeFileNames(names);
    EXPECT_EQ(safe[0], "房间");
    EXPECT_EQ(safe[1], "厨房");
    EXPECT_EQ(safe[2], "hall__east");
    EXPECT_EQ(safe[4], "hall_1") << "a name that needs no change keeps it";
    EXPECT_EQ(safe[11], "a_b");
    std::set<std::string> seen;
    for (const std::string& name : safe) {
        EXPECT_TRUE(seen.insert(lowerCase(name)).second) << name;
        EXPECT_EQ(name.find_first_of("/\\:*?\"<>|. \n"), std::string::npos) << name;
        EXPECT_LE(name.size(), 210u);
        EXPECT_TRUE(isUtf8(name)) << name;
    }
}

TEST(Places, aLinkIsAPlaceOfItsOwn) {
    const test::TempFolder folder;
    test::writeText(folder / "Folder/file.vox", "");
    std::filesystem::create_symlink("Folder/file.vox", folder / "link.vox");
    EXPECT_NE(placeOf(folder / "link.vox"), placeOf(folder / "Folder/file.vox"));
    EXPECT_EQ(canonicalName(folder / "link.vox"), canonicalName(folder / "Folder/file.vox"));
    EXPECT_EQ(placeOf(folder / "x/.././link.vox"), placeOf(folder / "link.vox"));
    EXPECT_EQ(placeOf(folder / "Folder/"), placeOf(folder / "Folder"));
    EXPECT_EQ(nearlyNamed(folder / "folder\\FILE.vox"), folder / "Folder/file.vox");
    EXPECT_EQ(nearlyNamed(folder / "Folder/file.vox"), std::nullopt);
    EXPECT_EQ(nearlyNamed(folder / "Folder/fil.vox"), std::nullopt);
}

// weakly_canonical leaves a relative path of which nothing exists as it is.
TEST(CanonicalName, isAbsoluteThoughNothingOfThePathExists) {
    const std::filesystem::path here = std::filesystem::canonical(".");
    EXPECT_EQ(canonicalName("no such folder/x.vox"), here / "no such folder/x.vox");
    EXPECT_EQ(canonicalName("./no such folder/../x.vox"), here / "x.vox");
    EXPECT_EQ(canonicalName("no such folder/"), here / "no such folder");
}

TEST(NearestWord, findsTyposAndBeginningsButNoStrangers) {
    const std::vector<std::string> words{"--force", "--explain", "--dry-run"};
    EXPECT_EQ(nearestWord("--forse", words), "--force");
    EXPECT_EQ(nearestWord("--FORCE", words), "--force");
    EXPECT_EQ(nearestWord("--expl", words), "--explain");
    EXPECT_EQ(nearestWord("--dryrun", words), "--dry-run");
    EXPECT_EQ(nearestWord("--brightness", words), std::nullopt);
}

TEST(Text, quantitiesReadWell) {
    EXPECT_EQ(formatBytes(0), "0 B");
    EXPECT_EQ(formatBytes(1023), "1023 B");
    EXPECT_EQ(formatBytes(1024), "1.0 KiB");
    EXPECT_EQ(formatBytes(1024 * 1024 - 1), "1.0 MiB") << "never 1024.0 KiB";
    EXPECT_EQ(formatCount(0), "0");
    EXPECT_EQ(formatCount(999), "999");
    EXPECT_EQ(formatCount(1234567), "1,234,567");
    EXPECT_EQ(plural(1, "file"), "1 file");
    EXPECT_EQ(plural(0, "file"), "0 files");
    EXPECT_EQ(formatDuration(185.0), "3 min 05 s");
}

TEST(Table, alignsByWhatIsSeenNotByBytes) {
    Table table({{"name"}, {"count", Align::Right}});
    table.addRow({"Tür", "7"});
    table.addRow({"Wand", "12"});
    EXPECT_EQ(table.render(), "name  count\nTür       7\nWand     12\n");
}

/// CLI11 wrote false into the variable of --filter, --no-filter while it was declared.
TEST(Switch, holdsWhatItHeldUntilItIsGiven) {
    struct Held {
        bool on = true;
        bool off = false;
        std::optional<bool> open;
    };
    const auto parsed = [](std::vector<std::string> arguments) {
        Held held;
        CLI::App app;
        addSwitch(app, "on", held.on, "");
        addSwitch(app, "off", held.off, "");
        addSwitch(app, "open", held.open, "", "--open");
        std::ranges::reverse(arguments);
        app.parse(arguments);
        return std::tuple(held.on, held.off, held.open);
    };
    EXPECT_EQ(parsed({}), std::tuple(true, false, std::optional<bool>()));
    EXPECT_EQ(parsed({"--no-on", "--off", "--open"}), std::tuple(false, true, std::optional(true)));
    EXPECT_EQ(parsed({"--on", "--no-off", "--no-open"}), std::tuple(true, false, std::optional(false)));
}

TEST(Limits, defaultsAreThoseOfTheReference) {
    const std::string reference =
        test::readText(std::filesystem::path(PFVOX_TESTS_DIR).parent_path() / "docs/cli.md");
    const std::size_t begin = reference.find("Limits and their defaults:");
    ASSERT_NE(begin, std::string::npos);
    const std::string listed = reference.substr(begin, reference.find("\n\n", begin) - begin);
    static const std::regex kLimit("`(max\\w+)` (\\d+[KMG]?)");
    const Limits defaults;
    static_assert(std::has_unique_object_representations_v<Limits>);
    std::size_t count = 0;
    for (std::sregex_iterator it(listed.begin(), listed.end(), kLimit), end; it != end; ++it, ++count) {
        const auto limits = parseLimits({(*it)[1].str() + "=" + (*it)[2].str()});
        ASSERT_TRUE(limits) << limits.error();
        EXPECT_EQ(std::memcmp(&*limits, &defaults, sizeof defaults), 0) << (*it)[0];
    }
    EXPECT_EQ(count, 8u);
}

TEST(ExitCode, ofARunFollowsItsFailures) {
    const std::vector<ErrorCode> none;
    const std::vector<ErrorCode> alike{ErrorCode::Truncated, ErrorCode::LimitExceeded};
    const std::vector<ErrorCode> mixed{ErrorCode::Truncated, ErrorCode::FileNotFound};
    EXPECT_EQ(exitCodeOf(none, 3), ExitCode::Ok);
    EXPECT_EQ(exitCodeOf(alike, 2), ExitCode::InvalidInput);
    EXPECT_EQ(exitCodeOf(alike, 3), ExitCode::SomeFailed);
    EXPECT_EQ(exitCodeOf(mixed, 2), ExitCode::SomeFailed);
    EXPECT_EQ(exitCodeOf(ErrorCode::GpuLost), ExitCode::Gpu);
    EXPECT_EQ(exitCodeOf(ErrorCode::Internal), ExitCode::Internal);
}

TEST(Depfile, escapesWhatMakeWouldMisread) {
    EXPECT_EQ(depfileText({{.target = "o ut", .prerequisites = {"a#b", "c$d", "~/e"}}}, DepfileReader::Make)
                  .value(),
              "o\\ ut: a\\#b c$$d ./~/e\n");
}

TEST(Depfile, ofNamesThatItsReaderCannotBeToldIsAnError) {
    const auto refused = [](DepfileReader reader, bool asTarget) {
        std::string characters;
        for (int code = ' '; code < 127; ++code) {
            const char c = static_cast<char>(code);
            const std::string name = std::string("x") + c + "y";
            const DepfileRule rule = asTarget ? DepfileRule{.target = name, .prerequisites = {"a"}}
                                              : DepfileRule{.target = "a", .prerequisites = {name}};
            const auto text = depfileText({rule}, reader);
            if (text) continue;
            EXPECT_EQ(text.error().file, name);
            EXPECT_THAT(text.error().message, ::testing::HasSubstr("rename it"));
            characters += c;
        }
        for (const std::string control : {"\n", "\t", "\r", "\x1b"})
            EXPECT_FALSE(depfileText({{.target = "a", .prerequisites = {"x" + control}}}, reader));
        return characters;
    };
    EXPECT_EQ(refused(DepfileReader::Make, false), "*:;=?[\\|");
    EXPECT_EQ(refused(DepfileReader::Make, true), "%*:;=?[\\|");
    EXPECT_EQ(refused(DepfileReader::Ninja, false), "\"#$&'*:;<>?\\^`|");
    for (const char* name : {"lib(member)", "all&"})
        EXPECT_FALSE(depfileText({{.target = "a", .prerequisites = {name}}}, DepfileReader::Make)) << name;
}

TEST(Batch, handsResultsOutInOrderForAnyNumberOfThreads) {
    for (const int threads : {1, 3, 8}) {
        constexpr std::size_t kCount = 200;
        std::vector<std::size_t> order;
        std::atomic<std::size_t> worked{0};
        const std::size_t started = runBatch(kCount, {.threads = threads, .failFast = false},
                                             {.work = [&](std::size_t i) { return ++worked, i % 7 != 0; },
                                              .finished = [&](std::size_t i) { order.push_back(i); },
                                              .progressed = {}});
        EXPECT_EQ(started, kCount);
        EXPECT_EQ(worked, kCount);
        ASSERT_EQ(order.size(), kCount);
        EXPECT_TRUE(std::ranges::is_sorted(order));
    }
}

TEST(Batch, commitsOverlapAndResultsStayInOrder) {
    for (const int threads : {1, 4}) {
        constexpr std::size_t kCount = 64;
        std::atomic<int> now{0};
        std::atomic<int> most{0};
        std::vector<std::atomic<bool>> committed(kCount);
        std::vector<std::size_t> order;
        runBatch(kCount, {.threads = threads, .failFast = false},
                 {.work = [&](std::size_t i) { return i % 5 != 0; },
                  .commit =
                      [&](std::size_t i) {
                          const int inside = ++now;
                          for (int seen = most; inside > seen && !most.compare_exchange_weak(seen, inside);) {
                          }
                          std::this_thread::sleep_for(std::chrono::milliseconds(5));
                          committed[i] = true;
                          --now;
                          return true;
                      },
                  .finished =
                      [&](std::size_t i) {
                          EXPECT_EQ(committed[i], i % 5 != 0) << "a failed one has nothing to commit";
                          order.push_back(i);
                      }});
        ASSERT_EQ(order.size(), kCount);
        EXPECT_TRUE(std::ranges::is_sorted(order));
        EXPECT_GT(most, 1) << "one thread that converts, several that wait";
    }
}

TEST(Batch, failFastStopsAfterAFailedCommit) {
    std::atomic<std::size_t> finished{0};
    const std::size_t started = runBatch(10000, {.threads = 1, .failFast = true},
                                         {.work =
                                              [](std::size_t) {
                                                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                                  return true;
                                              },
                                          .commit = [](std::size_t i) { return i != 4; },
                                          .finished = [&](std::size_t) { ++finished; }});
    EXPECT_LT(started, 10000u);
    EXPECT_EQ(finished, started);
}

TEST(Batch, failFastStartsNothingAfterAFailure) {
    std::size_t finished = 0;
    const std::size_t started = runBatch(100, {.threads = 1, .failFast = true},
                                         {.work = [](std::size_t i) { return i != 4; },
                                          .finished = [&](std::size_t) { ++finished; },
                                          .progressed = {}});
    EXPECT_EQ(started, 5u);
    EXPECT_EQ(finished, 5u);
}

/// Waits until a signal has come; ends with 1 after ten seconds without.
void awaitInterrupt() {
    for (int i = 0; i < 1000 && !isInterrupted(); ++i) ::usleep(10'000);
    if (!isInterrupted()) ::_exit(1);
}

TEST(Interrupt, endsWithTheLastWhoStopsInOrder) {
    const auto work = [] {
        ::signal(SIGINT, SIG_DFL);
        exitOnInterrupt();
        {
            const OrderlyStop outer;
            {
                const OrderlyStop inner;
                ::kill(::getpid(), SIGINT);
                awaitInterrupt();
            }
            // What an interrupted bake does last; a guard taken here once waited for ever.
            const OrderlyStop late;
        }
        ::_exit(2);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(130), "every output is either finished or as it was");
}

TEST(Interrupt, theSecondSignalEndsWorkThatDoesNotStop) {
    const auto work = [] {
        ::signal(SIGINT, SIG_DFL);
        exitOnInterrupt();
        const OrderlyStop never;
        ::kill(::getpid(), SIGINT);
        awaitInterrupt();
        ::kill(::getpid(), SIGINT);
        ::sleep(10);
        ::_exit(2);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(130), "");
}

/// Ends as a program whose work throws this.
template <class Exception>
[[noreturn]] void endWith(const Exception& exception) {
    ::_exit(runProgram([&]() -> ExitCode { throw exception; }));
}

TEST(Program, exceptionsBecomeMessagesWithRemedies) {
    EXPECT_EXIT(endWith(std::bad_alloc()), testing::ExitedWithCode(4), "error: not enough memory: .*-j");
    EXPECT_EXIT(endWith(std::system_error(EAGAIN, std::generic_category())), testing::ExitedWithCode(4),
                "ulimit -u");
    EXPECT_EXIT(endWith(std::runtime_error("odd")), testing::ExitedWithCode(70),
                "error: internal error: odd");
}

}  // namespace pfvox::tools
