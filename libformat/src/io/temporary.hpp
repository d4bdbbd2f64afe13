// Temporaries: names that outputs have before they are in their places, and how none of them stays.
#pragma once

#include <filesystem>
#include <pfvox/error.hpp>
#include <shared_mutex>

#include "io/descriptor.hpp"

namespace pfvox::io {

/// Held while a temporary name comes, goes or becomes an output. After abandonOutputs() nobody gets it any
/// more.
std::shared_lock<std::shared_mutex> enterNaming();

struct Temporary {
    Descriptor descriptor = Descriptor();
    std::filesystem::path name;  ///< empty: the file has none
};

/// An empty file in `folder`, open for writing, with the permissions that the umask leaves of 666. Errors:
/// errno is set.
Temporary createTemporary(const std::filesystem::path& folder);

/// Gives a file without a name one, as a temporary. Empty when that failed; errno is set. Precondition:
/// enterNaming().
std::filesystem::path nameTemporary(const std::filesystem::path& folder, const Descriptor& descriptor);

/// Gives a file without a name this one, which must be free. False when that failed; errno is set.
bool linkTo(const Descriptor& descriptor, const std::filesystem::path& name);

/// Removes a temporary, or forgets one that was renamed. Precondition: enterNaming().
void removeTemporary(const std::filesystem::path& name);
void forgetTemporary(const std::filesystem::path& name);

/// Removes the temporaries in a folder whose writers are gone. Looks once into each folder.
void removeLeftovers(const std::filesystem::path& folder);

}  // namespace pfvox::io
