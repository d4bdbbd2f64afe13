// Manifest repair: the second, lenient reading of a manifest.xml that is not well-formed. AbFab3D's own
// sphere is one.
#pragma once

#include <string>
#include <string_view>

namespace pfvox::import::svx {

/// The text with typographic quotes (UTF-8 or Windows-1252) around attributes made straight, and with
/// elements that are left open closed, where they hold nothing by their meaning (entry, channel). Bytes that
/// are not UTF-8 are converted. Lines stay.
std::string repairedManifest(std::string_view xml);

}  // namespace pfvox::import::svx
