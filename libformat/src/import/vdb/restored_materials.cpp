#include "import/vdb/restored_materials.hpp"

#include <fmt/format.h>

#include <string>

namespace pfvox::import::vdb {

Result<void> RestoredMaterials::appendTo(std::vector<Material>& materials, const Limits& limits) {
    struct Entry {
        std::size_t grid;
        const Material* material;
    };
    std::multimap<std::int64_t, Entry> byNumber;
    for (const auto& [grid, table] : tables_) {
        for (const auto& [label, material] : table) byNumber.emplace(label, Entry{grid, &material});
    }
    std::map<std::string, MaterialIndex> indexOf;
    for (const auto& [label, entry] : byNumber) {
        const std::string key = materialTable({{0, *entry.material}});
        const auto [known, isNew] = indexOf.emplace(key, static_cast<MaterialIndex>(materials.size()));
        if (isNew) materials.push_back(*entry.material);
        known_[entry.grid].emplace(label, known->second);
        if (materials.size() > limits.maxMaterials) {
            return fail(
                ErrorCode::LimitExceeded,
                fmt::format("the grids name more than {} materials (maxMaterials)", limits.maxMaterials));
        }
    }
    return {};
}

}  // namespace pfvox::import::vdb
