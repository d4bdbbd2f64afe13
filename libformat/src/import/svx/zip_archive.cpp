#include "import/svx/zip_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

namespace pfvox::import::svx {

namespace {

/// Deflate makes at most 1032 bytes of one (zlib's own figure); anything announced beyond that is a lie.
constexpr std::uint64_t kMaxInflation = 1032;

ErrorCode codeOf(int zipError) {
    switch (zipError) {
        case ZIP_ER_CRC:
            return ErrorCode::ChecksumMismatch;
        case ZIP_ER_COMPNOTSUPP:
        case ZIP_ER_ENCRNOTSUPP:
        case ZIP_ER_NOPASSWD:
        case ZIP_ER_WRONGPASSWD:
        case ZIP_ER_MULTIDISK:
            return ErrorCode::UnsupportedFeature;
        case ZIP_ER_EOF:
        case ZIP_ER_NOZIP:
            return ErrorCode::Truncated;
        default:
            return ErrorCode::BadStructure;
    }
}

/// Owns a zip_error_t.
class ZipError {
  public:
    ZipError() { zip_error_init(&error_); }
    ~ZipError() { zip_error_fini(&error_); }
    ZipError(const ZipError&) = delete;
    ZipError& operator=(const ZipError&) = delete;
    zip_error_t* get() { return &error_; }
    tl::unexpected<Error> toError(std::string_view action) {
        return fail(codeOf(zip_error_code_zip(&error_)),
                    fmt::format("{}: {}", action, zip_error_strerror(&error_)));
    }

  private:
    zip_error_t error_;
};

tl::unexpected<Error> entryError(const std::string& name, ErrorCode code, std::string message) {
    return tl::make_unexpected(
        Error{.code = code, .message = std::move(message), .context = "entry " + name});
}

}  // namespace

std::string lenientName(std::string_view name) {
    std::string key;
    for (const char c : name) key += c == '\\' ? '/' : (c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c);
    while (key.starts_with("./") || key.starts_with('/')) key.erase(0, key.front() == '.' ? 2 : 1);
    return key;
}

void ZipArchive::Discard::operator()(zip* archive) const noexcept {
    zip_discard(archive);
}

Result<ZipArchive> ZipArchive::open(std::span<const std::byte> bytes) {
    ZipError error;
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, error.get());
    if (source == nullptr) return error.toError("cannot read the zip archive");
    ZipArchive archive;
    archive.archive_.reset(zip_open_from_source(source, ZIP_RDONLY, error.get()));
    if (!archive.archive_) {
        zip_source_free(source);
        return error.toError(
            "cannot read the directory at the end of the zip archive; the file is damaged or cut");
    }
    const zip_int64_t count = zip_get_num_entries(archive.archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint64_t>(i);
        const char* name = zip_get_name(archive.archive_.get(), index, ZIP_FL_ENC_GUESS);
        archive.names_.emplace_back(name == nullptr ? "" : name);
        archive.indexOfName_.emplace(archive.names_.back(), index);
        archive.indexOfLenientName_.emplace(lenientName(archive.names_.back()), index);
    }
    return archive;
}

std::optional<ZipArchive::Entry> ZipArchive::find(std::string_view name) const {
    if (const auto exact = indexOfName_.find(std::string(name)); exact != indexOfName_.end()) {
        return Entry{.index = exact->second, .exactName = true};
    }
    const auto lenient = indexOfLenientName_.find(lenientName(name));
    if (lenient == indexOfLenientName_.end()) return std::nullopt;
    return Entry{.index = lenient->second, .exactName = false};
}

Result<std::vector<std::byte>> ZipArchive::read(std::uint64_t index, std::uint64_t maxBytes) const {
    const std::string& name = names_[static_cast<std::size_t>(index)];
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(archive_.get(), index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0 ||
        (stat.valid & ZIP_STAT_COMP_SIZE) == 0) {
        return entryError(name, ErrorCode::BadStructure, "has no size");
    }
    if (stat.size > maxBytes) {
        return entryError(name, ErrorCode::LimitExceeded,
                          fmt::format("announces {} bytes; at most {} make sense here", stat.size, maxBytes));
    }
    if (stat.size / kMaxInflation > stat.comp_size) {
        return entryError(
            name, ErrorCode::BadStructure,
            fmt::format("announces {} bytes, more than its {} bytes can hold", stat.size, stat.comp_size));
    }
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen_index(archive_.get(), index, 0),
                                                                 zip_fclose);
    if (!file) {
        const int zipError = zip_error_code_zip(zip_get_error(archive_.get()));
        return entryError(name, codeOf(zipError), zip_error_strerror(zip_get_error(archive_.get())));
    }
    std::vector<std::byte> contents(static_cast<std::size_t>(stat.size) +
                                    1);  // one more, to reach the end and its checksum
    std::size_t filled = 0;
    while (filled < contents.size()) {
        const zip_int64_t got = zip_fread(file.get(), contents.data() + filled, contents.size() - filled);
        if (got < 0) {
            const int zipError = zip_error_code_zip(zip_file_get_error(file.get()));
            return entryError(name, codeOf(zipError), zip_error_strerror(zip_file_get_error(file.get())));
        }
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
    }
    if (filled != stat.size) {
        return entryError(name, ErrorCode::Truncated,
                          fmt::format("{} bytes announced, {} found", stat.size, filled));
    }
    contents.resize(filled);
    return contents;
}

}  // namespace pfvox::import::svx
