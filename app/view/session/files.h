#pragma once
// Files to choose from: those of a folder, and those opened before.

#include <filesystem>
#include <string>
#include <vector>

namespace lacedring::view {

/// Meshes in the folder of `path`, by name; by their extensions alone.
std::vector<std::string> meshes_beside(const std::filesystem::path& path);

/// The meshes that come with the program (assets/); none where they were not installed.
std::vector<std::string> sample_meshes();

/// Newest first. Kept in $XDG_STATE_HOME/lacedring/recent (~/.local/state); lost silently where that cannot be written.
std::vector<std::string> read_recent();
void add_recent(std::vector<std::string>& recent, const std::string& path, bool write);

/// PREFIX-1.png, PREFIX-2.png, ...: the first that is not there yet.
std::string free_name(const std::string& prefix, const std::string& suffix);

}  // namespace lacedring::view
