#pragma once
// Small mesh files for the tests of readers and writers.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacedring/mesh.hpp"
#include "lacedring/mesh_files.hpp"

namespace lacedring::test {

/// A temporary folder that is removed when the process ends.
inline const std::filesystem::path& folder() {
    struct Folder {
        std::filesystem::path path =
            std::filesystem::temp_directory_path() / fmt::format("lacedring-test-{}", ::getpid());
        Folder() { std::filesystem::create_directories(path); }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    };
    static const Folder made;
    return made.path;
}

inline std::filesystem::path write_text(const std::string& name, std::string_view content) {
    const std::filesystem::path path = folder() / name;
    // Removed first: some file systems wait for the disk when an existing file is truncated and written.
    std::filesystem::remove(path);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    return path;
}

inline Result<Mesh> read_text(const std::string& name, std::string_view content) {
    return read_mesh(write_text(name, content));
}

/// Returns the mesh; fails the test with the reader's message if there is none.
inline Mesh must_read(const std::string& name, std::string_view content) {
    auto mesh = read_text(name, content);
    const std::string message = mesh ? std::string() : mesh.error().message;
    CAPTURE(message);
    REQUIRE(mesh.has_value());
    return *mesh;
}

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_endian) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

template <class T>
std::string packed(std::initializer_list<T> values) {
    std::string out;
    for (const T value : values) put(out, value);
    return out;
}

template <class T>
std::vector<T> values_of(const Mesh& mesh, std::string_view name) {
    const Attribute* attribute = find_attribute(mesh, name);
    if (attribute == nullptr || size_of(attribute->type) != sizeof(T)) return {};
    std::vector<T> out(attribute->data.size() / sizeof(T));
    std::memcpy(out.data(), attribute->data.data(), attribute->data.size());
    return out;
}

/// Names and types of the attributes: "POSITION:f32x3 COLOR_0:u8x4n", where n is for normalized.
inline std::string attributes_of(const Mesh& mesh) {
    constexpr std::string_view types[] = {"i8", "u8", "i16", "u16", "i32", "u32", "f32", "f64"};
    std::string out;
    for (const Attribute& a : mesh.attributes) {
        out += fmt::format("{}{}:{}x{}{}", out.empty() ? "" : " ", a.name, types[static_cast<std::size_t>(a.type)],
                           a.components, a.normalized ? "n" : "");
    }
    return out;
}

inline bool same(const Mesh& a, const Mesh& b) {
    return a.vertex_count == b.vertex_count && a.indices == b.indices && attributes_of(a) == attributes_of(b) &&
           std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(),
                      [](const Attribute& x, const Attribute& y) { return x.data == y.data; });
}

/// Returns whether the mesh keeps the invariant of Mesh (mesh.hpp).
inline bool is_sound(const Mesh& mesh) {
    if (mesh.indices.empty() || mesh.indices.size() % 3 != 0 || mesh.attributes.empty()) return false;
    for (const std::uint32_t v : mesh.indices) {
        if (v >= mesh.vertex_count) return false;
    }
    for (const Attribute& a : mesh.attributes) {
        if (a.components == 0 || a.data.size() != a.stride() * mesh.vertex_count) return false;
    }
    const Attribute& position = mesh.attributes.front();
    if (position.name != "POSITION" || position.components != 3) return false;
    const auto finite = [](auto values) {
        return std::all_of(values.begin(), values.end(), [](auto x) { return std::isfinite(x); });
    };
    if (position.type == ComponentType::f64) return finite(values_of<double>(mesh, "POSITION"));
    return position.type == ComponentType::f32 && finite(values_of<float>(mesh, "POSITION"));
}

inline std::string glb(std::string json, std::string bin) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    put(out, std::uint32_t{2});
    put(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bin.size()));
    put(out, static_cast<std::uint32_t>(json.size()));
    out += "JSON" + json;
    put(out, static_cast<std::uint32_t>(bin.size()));
    return out + std::string("BIN\0", 4) + bin;
}

/// A binary STL file of triangles of 9 floats each.
inline std::string binary_stl(std::span<const float> corners, std::string_view title = "binary") {
    std::string out(title);
    out.resize(80, '\0');
    put(out, static_cast<std::uint32_t>(corners.size() / 9));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i % 9 == 0) out += std::string(12, '\0');
        put(out, corners[i]);
        if (i % 9 == 8) out += std::string(2, '\0');
    }
    return out;
}

using Indices = std::vector<std::uint32_t>;
using Floats = std::vector<float>;

}  // namespace lacedring::test
