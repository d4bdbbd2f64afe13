// Findings: what validation of either format returns.
#pragma once

#include <pfvox/pf_vox.hpp>
#include <string>
#include <vector>

#include "guarded.hpp"

namespace pfvox::container {

/// Nobody reads more; and where a file is wrong in millions of places, they must not fill the memory.
inline constexpr std::size_t kMaxFindings = 1000;

inline Finding findingOf(Error fault) {
    return {.id = std::string(toString(fault.code)),
            .context = std::move(fault.context),
            .offsetBytes = fault.offsetBytes,
            .message = std::move(fault.message)};
}

/// What `validate` finds; an Error that it returns is a finding, too, and so is memory that does not suffice.
template <class Validate>
std::vector<Finding> findingsOf(const Validate& validate) {
    Result<std::vector<Finding>> findings = guarded(validate);
    if (!findings) return {findingOf(std::move(findings).error())};
    return *std::move(findings);
}

}  // namespace pfvox::container
