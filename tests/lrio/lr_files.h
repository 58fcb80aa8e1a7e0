#pragma once
// Helpers for the tests of .lr files.

#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lrcore/base/crc32.h"
#include "lrio/file/lr_layout.h"
#include "tests/support/meshes.h"

namespace lacedring::test {

constexpr Format kFormats[] = {Format::lean, Format::lr, Format::lr_compact, Format::packed};

inline Encoded encode_as(Format format, const Mesh& mesh) {
    EncodeOptions options{.format = format, .effort = 0};
    if (format == Format::lr_compact) options.periods = {0, 3};
    Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, options);
    REQUIRE_MESSAGE(encoded, encoded.error().message);
    return std::move(*encoded);
}

/// The index list without degenerate triangles.
inline std::vector<std::uint32_t> indices_of_kept(const Mesh& mesh) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto triangle = std::span(mesh.indices).subspan(i, 3);
        if (!oriented_triangles(triangle).empty()) out.insert(out.end(), triangle.begin(), triangle.end());
    }
    return out;
}

/// Compares bytes with the hexadecimal file `path`, and returns the file's bytes. After an intended change of the
/// format, which needs a new version number, LACEDRING_WRITE_GOLDEN=1 test_files -tc='golden*' rewrites the files.
inline std::vector<std::byte> check_golden(const std::string& path, std::span<const std::byte> bytes) {
    CAPTURE(path);
    std::string now;
    for (const std::byte b : bytes) {
        if (!now.empty() && now.size() % 97 == 96) now += '\n';
        now += "0123456789abcdef"[std::to_integer<unsigned>(b) >> 4U];
        now += "0123456789abcdef"[std::to_integer<unsigned>(b) & 15U];
    }
    now += '\n';
    if (std::getenv("LACEDRING_WRITE_GOLDEN") != nullptr) std::ofstream(path) << now;
    std::ifstream in(path);
    const std::string golden((std::istreambuf_iterator<char>(in)), {});
    CHECK_MESSAGE(now == golden, "the bytes are those of the golden file");
    std::vector<std::byte> out;
    for (std::size_t i = 0; i + 1 < golden.size(); i += golden[i + 2] == '\n' ? 3 : 2) {
        out.push_back(static_cast<std::byte>(std::stoi(golden.substr(i, 2), nullptr, 16)));
    }
    return out;
}

/// A section of an .lr file.
struct Part {
    detail::Section entry;
    std::vector<std::byte> contents;
};
/// Applies `change` to the header and sections of a file, and returns the changed file with valid offsets and
/// checksums.
inline std::vector<std::byte> with_parts(std::span<const std::byte> file,
                                         const std::function<void(detail::FileHeader&, std::vector<Part>&)>& change) {
    detail::FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    std::vector<Part> parts(header.sections);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        std::memcpy(&parts[i].entry, file.data() + sizeof header + i * sizeof(detail::Section),
                    sizeof(detail::Section));
        const auto contents = file.subspan(parts[i].entry.offset, parts[i].entry.size);
        parts[i].contents.assign(contents.begin(), contents.end());
    }
    change(header, parts);
    header.sections = static_cast<std::uint32_t>(parts.size());
    std::vector<std::byte> out(sizeof header + parts.size() * sizeof(detail::Section));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        out.resize(detail::align8(out.size()));
        parts[i].entry.offset = out.size();
        parts[i].entry.size = parts[i].contents.size();
        parts[i].entry.crc = crc32(parts[i].contents);
        out.insert(out.end(), parts[i].contents.begin(), parts[i].contents.end());
        std::memcpy(out.data() + sizeof header + i * sizeof(detail::Section), &parts[i].entry, sizeof(detail::Section));
    }
    header.table_crc = crc32(std::span(out).subspan(sizeof header, parts.size() * sizeof(detail::Section)));
    header.header_crc = crc32(std::as_bytes(std::span(&header, 1)).first(28));
    std::memcpy(out.data(), &header, sizeof header);
    return out;
}

/// Checks that `mesh` has the triangles of `of` except the degenerate ones, in order, and its vertices and attributes.
inline void check_same_mesh(const Result<Mesh>& mesh, const Mesh& of) {
    REQUIRE_MESSAGE(mesh, mesh.error().message);
    CHECK(mesh->vertex_count == of.vertex_count);
    CHECK_MESSAGE(mesh->indices == indices_of_kept(of), "the triangles are the same, in order");
    REQUIRE(mesh->attributes.size() == of.attributes.size());
    for (std::size_t a = 0; a < of.attributes.size(); ++a) {
        INFO("attribute ", of.attributes[a].name);
        CHECK(mesh->attributes[a].name == of.attributes[a].name);
        CHECK(mesh->attributes[a].type == of.attributes[a].type);
        CHECK(mesh->attributes[a].components == of.attributes[a].components);
        CHECK(mesh->attributes[a].normalized == of.attributes[a].normalized);
        CHECK(mesh->attributes[a].v_up == of.attributes[a].v_up);
        CHECK(mesh->attributes[a].data == of.attributes[a].data);
    }
}

}  // namespace lacedring::test
