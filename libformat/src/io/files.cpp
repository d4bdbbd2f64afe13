#include "io/files.hpp"

#include <fmt/format.h>

#include "guarded.hpp"
#include "io/pipe.hpp"
#include "io/random_file.hpp"

namespace pfvox::io {

Result<std::filesystem::path> pathFromText(std::string_view text) {
    if (text.empty()) return fail(ErrorCode::BadValue, "an empty path names nothing");
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
        return fail(ErrorCode::BadValue,
                    fmt::format("no path has a NUL character, and this one has it after {} bytes", nul));
    }
    return std::filesystem::path(text);
}

Result<void> checkReadable(const std::filesystem::path& file, std::uint64_t maxBytes) {
    PFVOX_CHECK(RandomFile::openForReading(file, maxBytes));
    return {};
}

Result<FileBytes> readFile(const std::filesystem::path& file, std::uint64_t maxBytes) {
    auto result = guarded([&]() -> Result<FileBytes> {
        std::error_code ignored;  // opening says what is wrong
        if (std::filesystem::is_fifo(file, ignored)) return readPipe(file, maxBytes);
        PFVOX_TRY(const RandomFile, input, RandomFile::openForReading(file, maxBytes));
        FileBytes contents(input.sizeBytes());
        PFVOX_TRY(const std::size_t, present, input.readFrom(0, contents.bytes()));
        contents.shrink(present);  // the file may have become shorter
        return contents;
    });
    if (!result && result.error().file.empty()) result.error().file = file;
    return result;
}

Result<void> writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                 WriteOptions options) {
    PFVOX_TRY(AtomicFile, output, AtomicFile::createWith(file, bytes, options));
    return output.commit();
}

}  // namespace pfvox::io
