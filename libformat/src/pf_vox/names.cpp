#include "pf_vox/names.hpp"

#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <pfvox/text_encoding.hpp>

namespace pfvox {

Result<NamePool> NamePool::read(const container::SectionReader& reader, const layout::Section& section) {
    const std::uint64_t size = section.rawBytes;
    PFVOX_CHECK(reader.checkSize(section, size));
    if (section.count >= size / sizeof(std::uint32_t))
        return container::failInSection(section, ErrorCode::BadStructure, "more names than bytes");
    PFVOX_CHECK(container::inSection(section, reader.budget().take(size)));
    const std::shared_ptr<char[]> raw(new char[size]);
    PFVOX_CHECK(reader.fill(section, std::as_writable_bytes(std::span(raw.get(), size))));
    NamePool pool;
    pool.raw_ = raw;
    pool.count_ = section.count;
    PFVOX_CHECK(pool.check(section, size));
    for (std::size_t i = 0; i < pool.count_; ++i) {
        const std::string_view text = pool.bytesOf(i);
        if (isUtf8(text)) continue;
        constexpr std::size_t kMostBytesEach = 3;  // of a character of Windows-1252
        PFVOX_CHECK(
            container::inSection(section, reader.budget().take(sizeof(Name) + kMostBytesEach * text.size())));
        pool.converted_.emplace(static_cast<std::uint32_t>(i), utf8FromWindows1252(text));
    }
    return pool;
}

Result<void> NamePool::check(const layout::Section& section, std::size_t size) {
    const std::size_t textBytes = size - (count_ + 1) * sizeof(std::uint32_t);
    for (std::size_t i = 0; i < count_; ++i) {
        if (endOf(i) > endOf(i + 1) || endOf(i + 1) > textBytes)
            return container::failInSection(section, ErrorCode::BadStructure,
                                            fmt::format("name {} lies outside", i));
    }
    return {};
}

std::uint32_t NamePool::endOf(std::size_t index) const {
    std::uint32_t end = 0;
    std::memcpy(&end, raw_.get() + index * sizeof end, sizeof end);
    return end;
}

std::string_view NamePool::bytesOf(std::size_t index) const {
    const char* const text = raw_.get() + (count_ + 1) * sizeof(std::uint32_t);
    return {text + endOf(index), text + endOf(index + 1)};
}

Name NamePool::at(std::uint32_t index) const {
    if (index >= count_) return {};
    if (const auto known = converted_.find(index); known != converted_.end()) return known->second;
    return Name(raw_, bytesOf(index));
}

std::optional<std::uint32_t> NamePool::firstForeign() const {
    return converted_.empty() ? std::nullopt : std::optional(converted_.begin()->first);
}

std::uint32_t NameTable::add(std::string_view name) {
    const auto [entry, isNew] = indexOf_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (isNew) names_.push_back(name);
    return entry->second;
}

Result<container::SectionContent> NameTable::section() const {
    container::SectionContent s{.fourcc = "NAME", .count = names_.size()};
    std::vector<std::uint32_t> ends{0};
    for (const std::string_view name : names_) {
        if (!isUtf8(name)) {
            return fail(ErrorCode::BadValue,
                        fmt::format("section NAME: name {} is not UTF-8: utf8FromWindows1252() makes it so",
                                    ends.size() - 1));
        }
        if (name.size() > std::numeric_limits<std::uint32_t>::max() - ends.back())
            return fail(ErrorCode::LimitExceeded, "section NAME: names of more than 4 GiB");
        ends.push_back(ends.back() + static_cast<std::uint32_t>(name.size()));
    }
    container::appendBytes(s.raw, std::span<const std::uint32_t>(ends));
    for (const std::string_view name : names_) container::appendBytes(s.raw, std::span(name));
    return s;
}

}  // namespace pfvox
