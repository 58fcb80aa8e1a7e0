#include "app/cli/scene_output.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <system_error>

#include "app/cli/input.h"

namespace lacedring::app {
namespace {

namespace fs = std::filesystem;

/// Percent-encodes a file name for a URI.
std::string uri_of(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                           c == '-' || c == '_' || c == '~';
        out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return out;
}

fs::path beside(const SceneOutput& output, std::string_view extension) {
    return output.path.parent_path() / (output.path.stem().string() + std::string(extension));
}

/// Applies check_output to all files that would be written.
Result<void> check_files(const SceneOutput& output, const OutputOptions& options, const RunLog& log) {
    constexpr std::array<std::string_view, 2> kScenes = {".glb", ".gltf"};
    constexpr std::array<std::string_view, 1> kBuffers = {".bin"};
    if (auto good = check_output(output.path, options, log, kScenes); !good || output.bin.empty()) return good;
    for (const char* extension : {".bin", ".fallback.bin"}) {
        const fs::path path = beside(output, extension);
        if (auto good = check_output(path, options, log, kBuffers); !good) {
            return Error{good.error().code, fmt::format("{}: {}", path.filename().string(), good.error().message)};
        }
    }
    return {};
}

/// Writes the buffers, then the document. Returns the size of all files in bytes.
Result<std::uint64_t> write_files(const SceneFile& scene, const SceneOutput& output) {
    if (output.bin.empty()) {
        const auto head = make_glb_head(scene);
        if (!head) return head.error();
        constexpr std::array<std::byte, 3> kZeros{};
        const auto tail = std::span(kZeros).first((4 - scene.bin.size() % 4) % 4);
        const std::span<const std::byte> parts[] = {*head, scene.bin, tail};
        if (auto written = write_output(output.path, parts); !written) return written.error();
        return head->size() + scene.bin.size() + tail.size();
    }
    const auto write = [](const fs::path& path, std::span<const std::byte> bytes) -> Result<void> {
        const std::span<const std::byte> parts[] = {bytes};
        return bytes.empty() ? Result<void>() : write_output(path, parts);
    };
    if (auto good = write(beside(output, ".bin"), scene.bin); !good) return good.error();
    if (auto good = write(beside(output, ".fallback.bin"), scene.fallback); !good) return good.error();
    if (auto good = write(output.path, std::as_bytes(std::span(scene.json))); !good) return good.error();
    return scene.json.size() + scene.bin.size() + scene.fallback.size();
}

/// Adds a note if the scene refers to image files, which are not copied, and the output is in another folder.
void note_images(const SceneFile& scene, const std::string& input, const SceneOutput& output, RunLog& log) {
    std::error_code error;
    const fs::path from = fs::path(input).parent_path(), to = output.path.parent_path();
    const bool same =
        input != "-" && output.path != "-" && fs::equivalent(from.empty() ? "." : from, to.empty() ? "." : to, error);
    if (same) return;
    const auto document = nlohmann::json::parse(scene.json, nullptr, false);
    const auto images = document.is_object() ? document.find("images") : document.end();
    if (images == document.end() || !images->is_array()) return;
    std::size_t files = 0;
    for (const auto& image : *images) {
        const auto uri = image.is_object() ? image.find("uri") : image.end();
        if (uri != image.end() && uri->is_string() && !uri->get_ref<const std::string&>().starts_with("data:")) ++files;
    }
    if (files > 0) {
        log.note(output_name(output.path),
                 fmt::format("{} image{} not copied: {} to lie beside it, as beside {}", files,
                             files == 1 ? " is" : "s are", files == 1 ? "it has" : "they have", input_name(input)));
    }
}

}  // namespace

SceneOutput::SceneOutput(const fs::path& to) : path(to) {
    if (path.extension() != ".gltf") return;
    bin = uri_of(path.stem().string() + ".bin");
    fallback = uri_of(path.stem().string() + ".fallback.bin");
}

Result<std::vector<std::byte>> read_scene(const std::string& path, const InputOptions& options, RunLog& log) {
    auto bytes = read_input(path, options, log);
    if (!bytes) return bytes.error();
    if (is_lr(*bytes)) return Error{ErrorCode::unsupported, "is an .lr file, not glTF (lacedring decode reads it)"};
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    const std::size_t start = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
    if (start != std::string_view::npos && text[start] != '{' && !text.starts_with("glTF")) {
        return Error{ErrorCode::unsupported, "is no glTF (lacedring encode takes meshes of other formats)"};
    }
    return bytes;
}

Result<std::uint64_t> write_scene(const SceneFile& scene, const std::string& input, const SceneOutput& output,
                                  const OutputOptions& options, RunLog& log) {
    if (auto good = check_files(output, options, log); !good) return good.error();
    auto bytes = write_files(scene, output);
    if (bytes) note_images(scene, input, output, log);
    return bytes;
}

std::uint64_t input_bytes(std::uint64_t file, const ReadReport& read) {
    for (const fs::path& path : read.files) {
        std::error_code error;
        const auto size = fs::file_size(path, error);
        if (!error) file += size;
    }
    return file;
}

}  // namespace lacedring::app
