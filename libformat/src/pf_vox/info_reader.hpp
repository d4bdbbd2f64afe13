// InfoReader: the sections beside the octrees: MATL, INST, INSX, LAYR, CAMR, META and NAME.
#pragma once

#include <pfvox/asset.hpp>

#include "pf_vox/names.hpp"
#include "pf_vox/record_rules.hpp"
#include "pf_vox/section_index.hpp"

namespace pfvox {

/// The tables as they are stored; not checked.
struct InfoRecords {
    NamePool names;
    container::Array<layout::Material> materials;
    container::Array<layout::Instance> instances;
    container::Array<layout::Place> places;  ///< empty, or one an instance
    container::Array<layout::Layer> layers;
    container::Array<layout::Camera> cameras;
    layout::Meta meta{};
    container::Array<std::uint32_t> notes;

    InfoTables tables() const {
        return {.materials = materials,
                .instances = instances,
                .places = places,
                .layerCount = layers.size(),
                .cameras = cameras,
                .meta = meta};
    }
};

/// Errors: those of PfVoxSections::readTable, BadStructure.
Result<InfoRecords> readInfo(const PfVoxSections& sections, const Limits& limits);

/// Precondition: the records were checked. Errors: LimitExceeded.
Result<void> makeInfo(const InfoRecords& records, container::MemoryBudget& budget, AssetInfo& info);

}  // namespace pfvox
