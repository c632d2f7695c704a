// The manifest.json of a recording.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/logs/recording.h"

namespace lodemark {

// Fills recording by the text of its manifest. File names that are no plain relative paths inside
// the folder, or that name nothing there, are left out with a sentence in recording->problems.
// path is for messages.
Status ReadManifest(const std::string& path, std::string_view text, Recording* recording);

// Whether a name in a manifest stays inside the folder of the manifest.
bool StaysInFolder(std::string_view name);

}  // namespace lodemark
