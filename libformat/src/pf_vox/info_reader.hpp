// InfoReader: the sections beside the octrees (MATL, INST, LAYR, CAMR, META, NAME), and tables of records in
// general.
#pragma once

#include <fmt/format.h>
#include <cstring>
#include <pfvox/asset.hpp>
#include <string>
#include <vector>

#include "pf_vox/section_index.hpp"
#include "pf_vox/section_reader.hpp"

namespace pfvox {

/// The NAME section. Indices that do not exist give the empty string: a name decides nothing.
class NameList {
  public:
    NameList() = default;
    explicit NameList(std::vector<std::string> names) : names_(std::move(names)) {}
    std::string at(std::uint32_t index) const {
        return index < names_.size() ? names_[index] : std::string{};
    }

  private:
    std::vector<std::string> names_;
};

/// Reads a table of fixed-size records. Errors: BadStructure (missing, wrong size), LimitExceeded, those of
/// readSection.
template <class Record>
Result<std::vector<Record>> readRecords(std::span<const std::byte> file, const SectionIndex& index,
                                        std::string_view fourcc, std::uint64_t maxCount) {
    const layout::Section* section = index.find(fourcc);
    if (section == nullptr)
        return fail(ErrorCode::BadStructure, fmt::format("section {} is missing", fourcc));
    if (section->count > maxCount) {
        return failInSection(*section, ErrorCode::LimitExceeded,
                             fmt::format("{} records, at most {} are accepted", section->count, maxCount));
    }
    PFVOX_TRY(const auto, raw, readSection(file, *section, section->count * sizeof(Record)));
    std::vector<Record> records(section->count);
    if (!raw.empty()) std::memcpy(records.data(), raw.data(), raw.size());
    return records;
}

/// Fills everything of `info`; `names` is needed for the models too. Errors: those of readRecords, BadValue,
/// BadReference.
Result<void> readInfo(std::span<const std::byte> file, const SectionIndex& index, const Limits& limits,
                      NameList& names, AssetInfo& info);

}  // namespace pfvox
