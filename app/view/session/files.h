#pragma once
// Lists of files to choose from: the meshes in a folder, samples, and files opened before.

#include <filesystem>
#include <string>
#include <vector>

namespace lacedring::view {

/// The meshes in the folder of `path`, sorted by name. Only extensions are looked at.
std::vector<std::string> meshes_beside(const std::filesystem::path& path);

/// The meshes that come with the program (assets/); empty if they were not installed.
std::vector<std::string> sample_meshes();

/// Files opened before, newest first, kept in $XDG_STATE_HOME/lacedring/recent (~/.local/state). If that cannot be
/// written, the list is lost without a message.
std::vector<std::string> read_recent();
void add_recent(std::vector<std::string>& recent, const std::string& path, bool write);

/// The first name of PREFIX-1SUFFIX, PREFIX-2SUFFIX, ... that does not exist.
std::string free_name(const std::string& prefix, const std::string& suffix);

}  // namespace lacedring::view
