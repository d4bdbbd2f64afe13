// RecordRules: what the records of a PF_VOX file may say, each for itself and about each other. The reader
// asks before it believes a table, the writer before it stores one.
#pragma once

#include <functional>
#include <pfvox/error.hpp>
#include <pfvox/limits.hpp>
#include <span>

#include "pf_vox/layout.hpp"

namespace pfvox {

/// Takes note of a fault, whose context names section and record; true when the other records are to be
/// checked, too.
using FaultSink = std::function<bool(std::string_view fourcc, Error fault)>;

/// MATL, INST, INSX, LAYR, CAMR and META.
struct InfoTables {
    std::span<const layout::Material> materials;
    std::span<const layout::Instance> instances;
    std::span<const layout::Place> places;  ///< empty, or one an instance
    std::size_t layerCount = 0;
    std::span<const layout::Camera> cameras;
    layout::Meta meta{};
};
/// MODL, REGN and PALT.
struct ModelTables {
    std::span<const layout::Model> models;
    std::span<const layout::Region> regions;
    std::span<const std::uint16_t> palettes;
};

/// The domains of all fields, layers that exist, and exact places that are those of the instances. Faults:
/// BadValue, BadReference.
bool checkInfo(const InfoTables& tables, const FaultSink& sink);

/// The domains of all fields; that the regions of the models follow each other, lie where the models say and
/// have together their voxels and bounds; that palettes are inside PALT and name materials. No sum overflows
/// afterwards. Faults: BadValue, BadReference, BadStructure, LimitExceeded.
bool checkModels(const ModelTables& tables, std::size_t materialCount, const Limits& limits,
                 const FaultSink& sink);

/// Models that instances place. Faults: BadReference.
bool checkPlacements(std::span<const layout::Instance> instances, std::size_t modelCount,
                     const FaultSink& sink);

}  // namespace pfvox
