#include <gtest/gtest.h>

#include <pfvox/error.hpp>
#include <set>
#include <thread>

namespace pfvox {
namespace {

TEST(Error, IsDescribedWithFilePlaceAndMessage) {
    Error error{.code = ErrorCode::BadReference,
                .message = "child node 77 does not exist",
                .file = "hall.vox",
                .offsetBytes = 0x1a3f,
                .context = "chunk nTRN"};
    EXPECT_EQ(describe(error), "hall.vox: chunk nTRN @0x1a3f: child node 77 does not exist");
    error.context.clear();
    EXPECT_EQ(describe(error), "hall.vox: @0x1a3f: child node 77 does not exist");
    error.offsetBytes.reset();
    EXPECT_EQ(describe(error), "hall.vox: child node 77 does not exist");
    error.file.clear();
    EXPECT_EQ(describe(error), "child node 77 does not exist");
}

TEST(Error, EveryCodeHasASpellingOfItsOwn) {
    std::set<std::string_view> seen;
    for (const int code :
         {100, 101, 102, 200, 201, 202, 203, 204, 205, 206, 300, 301, 302, 400, 500, 501, 502, 600, 900}) {
        const std::string_view text = toString(static_cast<ErrorCode>(code));
        EXPECT_NE(text, "unknown") << code;
        EXPECT_TRUE(seen.insert(text).second) << text;
    }
}

Result<int> half(int n) {
    if (n % 2 != 0) return fail(ErrorCode::BadValue, "odd");
    return n / 2;
}
Result<int> quarter(int n) {
    PFVOX_TRY(const int, h, half(n));
    return half(h);
}

TEST(Result, TryHandsErrorsOn) {
    EXPECT_EQ(quarter(8).value(), 2);
    EXPECT_EQ(quarter(6).error().message, "odd");
    EXPECT_EQ(quarter(7).error().code, ErrorCode::BadValue);
}

TEST(Diagnostics, ListTakesReportsFromSeveralThreads) {
    DiagnosticList list;
    std::thread other([&] {
        for (int i = 0; i < 500; ++i) list.warn("a", "b");
    });
    for (int i = 0; i < 500; ++i) list.note("c", "d");
    other.join();
    EXPECT_EQ(list.entries().size(), 1000u);
}

}  // namespace
}  // namespace pfvox
