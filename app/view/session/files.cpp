#include "app/view/session/files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <span>
#include <sstream>

#include "lacedring/file.hpp"

namespace lacedring::view {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRecent = 12;

fs::path recent_file() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0') {
        return fs::path(state) / "lacedring" / "recent";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
        return fs::path(home) / ".local" / "state" / "lacedring" / "recent";
    }
    return {};
}

}  // namespace

std::vector<std::string> meshes_beside(const fs::path& path) {
    constexpr std::array<std::string_view, 7> kExtensions{".glb", ".gltf", ".obj", ".ply", ".off", ".stl", ".lr"};
    std::vector<std::string> out;
    std::error_code error;
    const fs::path folder = fs::is_directory(path, error) ? path : fs::absolute(path, error).parent_path();
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        std::string extension = it->path().extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        std::error_code ignored;
        if (std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end() &&
            it->is_regular_file(ignored)) {
            out.push_back(it->path().string());
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> sample_meshes() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    // "lacedring-assets" is beside the program in the build folder; LACEDRING_ASSETS is the path from an installed one.
    for (const char* place : {"lacedring-assets", LACEDRING_ASSETS}) {
        if (fs::is_directory(folder / place, error)) return meshes_beside(folder / place);
    }
    return {};
}

std::vector<std::string> read_recent() {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 20;  // far more than a dozen paths
    const Result<std::vector<std::byte>> bytes = read_file(recent_file(), kMost);
    std::vector<std::string> out;
    if (!bytes) return out;
    std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
    for (std::string line; out.size() < kMostRecent && std::getline(lines, line);) {
        if (!line.empty()) out.push_back(line);
    }
    return out;
}

void add_recent(std::vector<std::string>& recent, const std::string& path, bool write) {
    std::error_code error;
    const std::string full = fs::absolute(path, error).string();
    if (error || full.find('\n') != std::string::npos) return;
    std::erase(recent, full);
    recent.insert(recent.begin(), full);
    if (recent.size() > kMostRecent) recent.resize(kMostRecent);
    const fs::path to = recent_file();
    if (!write || to.empty()) return;
    fs::create_directories(to.parent_path(), error);
    // Do not write to a pipe or a device of that name: it may block.
    const fs::file_type there = fs::status(to, error).type();
    if (there != fs::file_type::regular && there != fs::file_type::not_found) return;
    std::string text;
    for (const std::string& line : recent) text += line + '\n';
    const std::span<const std::byte> part = std::as_bytes(std::span(text));
    (void)write_file(to, std::span(&part, 1));  // on failure only the list is lost
}

std::string free_name(const std::string& prefix, const std::string& suffix) {
    for (int i = 1;; ++i) {
        std::string name = prefix + "-" + std::to_string(i) + suffix;
        std::error_code error;
        if (!fs::exists(name, error)) return name;
    }
}

}  // namespace lacedring::view
