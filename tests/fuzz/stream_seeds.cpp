// Writes seeds: fuzz_stream_seeds FOLDER writes small valid streams, .lr files and inputs of the chain target to
// FOLDER/lean/NAME, ...; fuzz_stream_seeds FOLDER SCENE... writes packed scenes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "lacedring/file.hpp"
#include "lacedring/lacedring.hpp"
#include "lacedring/lr_file.hpp"
#include "lacedring/ring.hpp"
#include "lacedring/scene.hpp"
#include "lacedring/seams.hpp"
#include "lacedring/vertices.hpp"
#include "lrcore/codec/storage/packed_storage.h"
#include "lrcore/codec/storage/seam_storage.h"
#include "lrcore/codec/storage/vertex_storage.h"
#include "lrlab/generate/generate.h"
#include "tests/support/cut_mesh.h"
#include "tests/support/meshes.h"

using namespace lacedring;

namespace {

std::filesystem::path folder;
bool all_written = true;

void write(const char* target, const std::string& name, std::span<const std::byte> bytes) {
    if (bytes.size() > 8192) return;  // the limit of scripts/fuzz
    std::filesystem::create_directories(folder / target);
    const std::span<const std::byte> parts[] = {bytes};
    all_written = write_file(folder / target / name, parts).has_value() && all_written;
}

void write_stream(const char* target, const std::string& name, const Mesh& mesh, const Encoded& encoded) {
    write(target, name, encoded.bytes());
    if (encoded.format == Format::packed && mesh.triangle_count() > 150) {  // fewer triangles have no storage form
        const LrFile file = make_lr_file(mesh, encoded, false);
        write("lr_file", std::string(target) + "-" + name + "-stored", serialize_lr(file, LrForm::stored));
    }
    if (mesh.triangle_count() > 60) return;
    LrFile file = make_lr_file(mesh, encoded, mesh.triangle_count() % 2 == 0);
    write("lr_file", std::string(target) + "-" + name, serialize_lr(file));
    const AttributeBits bits{.positions = mesh.vertex_count % 3 * 5, .normals = 8};  // 0: lossless
    all_written = compress_attributes(file, bits).has_value() && all_written;
    write("lr_file", std::string(target) + "-" + name + "-vertices", serialize_lr(file));
    const auto [cut, surface] = test::cut_mesh(mesh, 1 + mesh.vertex_count % 4, mesh.vertex_count);
    const Result<LrFile> seams = make_lr_file(cut, surface, encoded, mesh.triangle_count() % 3 == 0);
    all_written = seams.has_value() && all_written;
    if (seams) write("lr_file", std::string(target) + "-" + name + "-seams", serialize_lr(*seams));
    if (seams)
        write("lr_file", std::string(target) + "-" + name + "-stored-seams", serialize_lr(*seams, LrForm::stored));
}

/// Writes the seam section of a mesh cut into charts of `chart` consecutive triangles.
void write_seams(const std::string& name, const Encoded& encoded, std::uint32_t vertices, std::uint32_t chart) {
    const std::vector<std::uint32_t> triangles = slot_triangles(view_stream(encoded.words).value());
    std::vector<std::uint32_t> words{vertices, static_cast<std::uint32_t>(triangles.size() / 3)}, copies;
    for (std::size_t c = 0; c < triangles.size(); ++c) {
        const auto copy = static_cast<std::uint32_t>(triangles[c] + vertices * (c / 3 / chart % 4));
        copies.push_back(triangles[c] == UINT32_MAX ? UINT32_MAX : copy);
    }
    const Result<EncodedSeams> seams = encode_seams(triangles, vertices, copies);
    all_written = seams.has_value() && all_written;
    if (!seams) return;
    words.insert(words.end(), triangles.begin(), triangles.end());
    words.insert(words.end(), seams->words.begin(), seams->words.end());
    write("seams", name, std::as_bytes(std::span(words)));
}

void write_seeds(std::string name, const Mesh& mesh, std::uint32_t number) {
    std::replace(name.begin(), name.end(), ' ', '-');
    const CornerTable table = build_corner_table(mesh.indices, mesh.vertex_count).value();
    Rings rings = expand_rings(table, {.k = number % 4});
    if (number % 2 == 0) rings = optimize_rings(table, std::move(rings), {.passes = 2});
    const Encoded lean = as_encoded(*encode_lean(table, rings));
    write_stream("lean", name, mesh, lean);
    write_seams(name + "-lean", lean, mesh.vertex_count, 1 + number % 7);
    for (const PackedProfile profile : {PackedProfile::small, PackedProfile::cache}) {
        PackedChoice packed =
            encode_smallest_packed(table, {.k = number % 4}, {.passes = 2 - number % 2 * 2}, profile).value();
        const Encoded encoded = as_encoded(std::move(packed.stream));
        write_stream("packed", name + (profile == PackedProfile::cache ? "-cache" : ""), mesh, encoded);
        if (profile == PackedProfile::small) write_seams(name, encoded, mesh.vertex_count, 1 + number % 20);
    }
    if (mesh.triangle_count() <= 200) {
        write_stream("lr", name, mesh, as_encoded(*encode_lr(table, {.k = number % 4})));
        const std::array<std::uint32_t, 1> periods{number % 4};
        write_stream("lr_compact", name, mesh, as_encoded(*encode_compact_lr(table, {}, periods)));
    }
    if (mesh.vertex_count <= 256 && mesh.triangle_count() <= 100) {
        std::vector<std::byte> input;
        for (const std::uint32_t v : mesh.indices) input.push_back(static_cast<std::byte>(v));
        const std::uint32_t warts = number % 3 == 0 ? 0x80 : 0, copies = number % 5 == 0 ? 2 + number % 8 * 2 : 0;
        for (const std::uint32_t option : {0x40U | warts, number % 7, number % 3, number % 4, number, 255U, copies, 3U,
                                           number % 2 == 0 ? 0U : 1U << number % 6}) {
            input.push_back(static_cast<std::byte>(option));
        }
        write("chain_indices", name, input);
        if (number % 4 != 1) return;
        input[input.size() - 9] =
            static_cast<std::byte>(number % 8 == 1 ? 0x60 : 0x0c);  // not joined; with or without its order
        input[input.size() - 4] = static_cast<std::byte>(4 * (2 + number % 16));       // positions repeat
        input[input.size() - 3] = static_cast<std::byte>(number % 3 == 0 ? 0xc0 : 0);  // a tolerance
        write("chain_indices", name + "-cut", input);
    }
}

/// Writes vertex streams of several sizes with the values value(vertex, component).
template <class T, class Value>
void write_vertices(const char* name, ComponentType type, std::uint8_t components, const VertexOptions& options,
                    Value value) {
    for (const std::uint32_t vertices : {0U, 1U, 5U, 128U, 129U, 2100U}) {
        std::vector<T> values;
        for (std::uint32_t v = 0; v < vertices; ++v) {
            for (std::uint32_t c = 0; c < components; ++c) values.push_back(static_cast<T>(value(v, c)));
        }
        const bool normalized = type == ComponentType::u8;
        const Result<EncodedVertices> encoded =
            encode_vertices({type, components, normalized, std::as_bytes(std::span(values))}, options);
        all_written = encoded.has_value() && all_written;
        if (encoded) {
            write("vertices", std::string(name) + "-" + std::to_string(vertices),
                  std::as_bytes(std::span(encoded->words)));
        }
    }
}

/// Writes vertex streams of every mapping.
void write_vertex_seeds() {
    const auto wave = [](std::uint32_t v, std::uint32_t c) { return std::sin(v * (0.05 + 0.02 * c)); };
    const auto noise = [](std::uint32_t v, std::uint32_t c) { return (2 * v + c + 1) * 2654435761U; };
    const auto tangent = [&](std::uint32_t v, std::uint32_t c) {
        return c == 3 ? (v % 100 < 50 ? 1 : -1) : c == 2 ? std::sin(v * 0.3) : wave(v, c);
    };
    const auto decimal = [&](std::uint32_t v, std::uint32_t c) {
        return v % 40 == 3 ? wave(v, c) : std::round(wave(v, c) * 1000) / 1000;
    };
    write_vertices<std::uint8_t>("u8", ComponentType::u8, 4, {},
                                 [&](auto v, auto c) { return 120 + 100 * wave(v, c); });
    write_vertices<std::int16_t>("i16", ComponentType::i16, 2, {}, [&](auto v, auto c) { return 3000 * wave(v, c); });
    write_vertices<std::uint32_t>("u32", ComponentType::u32, 1, {}, [](auto v, auto) { return v / 3; });
    write_vertices<std::uint32_t>("u32-noise", ComponentType::u32, 1, {}, noise);
    // These types hold any integer.
    write_vertices<std::int32_t>("i32", ComponentType::i32, 3, {},
                                 [&](auto v, auto c) { return (v % 64 < 2 ? 0x7fffffff : 1e6) * wave(60 * v, c); });
    write_vertices<double>("doubles-noise", ComponentType::f64, 1, {}, wave);
    write_vertices<float>("lattice", ComponentType::f32, 3, {.mapping = VertexMapping::lattice, .bits = 9}, wave);
    const VertexOptions octahedral{.mapping = VertexMapping::octahedral, .bits = 7};
    write_vertices<float>("normals", ComponentType::f32, 3, octahedral, tangent);
    write_vertices<float>("tangents", ComponentType::f32, 4, octahedral, tangent);
    write_vertices<float>("floats", ComponentType::f32, 1, {}, wave);
    write_vertices<float>("decimals", ComponentType::f32, 2, {}, decimal);
    write_vertices<double>("doubles", ComponentType::f64, 1, {},
                           [&](auto v, auto c) { return std::round(wave(v, c) * 4096) / 4096; });
}

/// Writes the sections of a cut mesh in storage form as an input of stored.cpp, with normals or texture coordinates.
void write_stored(const std::string& name, const Mesh& mesh, bool normals) {
    const Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.format = Format::packed, .effort = 0});
    all_written = encoded.has_value() && all_written;
    if (!encoded) return;
    auto [cut, surface] = test::cut_mesh(mesh, 2, mesh.vertex_count);
    const Mesh more{cut.vertex_count, {}, {cut.attributes[0]}};
    const std::vector<float> positions = positions_f32(more);
    Attribute attribute{normals ? "NORMAL" : "TEXCOORD_0", ComponentType::f32, 3, false, {}};
    std::vector<float> values;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (normals || i % 3 != 2)
            values.push_back(positions[i] + 0.03F * static_cast<float>(i / 3 % 4));  // copies differ
    }
    if (!normals) attribute.components = 2;
    const auto bytes = std::as_bytes(std::span(values));
    attribute.data.assign(bytes.begin(), bytes.end());
    cut.attributes = {cut.attributes[0], std::move(attribute)};
    Result<LrFile> file = make_lr_file(cut, surface, *encoded, false);
    if (file && !compress_attributes(*file, {.positions = 10, .normals = 8, .texcoords = 9})) return;
    all_written = file.has_value() && all_written;
    if (!file) return;
    const auto stream = view_stream(file->words);
    const std::vector<std::uint32_t> slots = slot_triangles(*stream);
    const auto packed = storage::store_packed(*view_packed(file->words));
    std::vector<std::uint32_t> positions_of, copies, vertex_of;
    const VertexView position = *view_vertices(file->attributes[0].words);
    positions_of.resize(std::size_t{3} * position.vertices);
    for (std::uint32_t b = 0; b < position.blocks(); ++b)
        decode_vertex_block(position, b, std::span(positions_of).subspan(std::size_t{3} * kVertexBlock * b));
    std::vector<std::uint32_t> words{file->vertex_count, static_cast<std::uint32_t>(slots.size() / 3)};
    using Stored = std::optional<std::vector<std::uint32_t>>;
    Stored seams;
    if (!file->seams.empty()) {
        const SeamView view = *view_seams(file->seams, stream->slots(), stream->vertices());
        copies.resize(slots.size());
        vertex_of.resize(view.copies);
        decode_seams(view, slots, copies);
        copy_vertices(view, slots, vertex_of);
        seams = storage::store_seams(view, slots);
    }
    const auto stored_positions = storage::store_vertices(position, slots);
    const bool per_copy = file->attributes[1].per_copy;
    const auto stored_attribute =
        storage::store_vertices(*view_vertices(file->attributes[1].words), per_copy ? copies : slots,
                                {positions_of, std::span(vertex_of).first(per_copy ? vertex_of.size() : 0)});
    for (const Stored* part : {&packed, &stored_positions, &stored_attribute})
        words.push_back(*part ? static_cast<std::uint32_t>((*part)->size()) : 0);
    for (const Stored* part :
         std::initializer_list<const Stored*>{&packed, &stored_positions, &stored_attribute, &seams}) {
        if (*part) words.insert(words.end(), (*part)->begin(), (*part)->end());
    }
    write("stored", name, std::as_bytes(std::span(words)));
}

/// Writes a file in storage form whose normals are differences from the surface's.
void write_stored_normals() {
    Mesh mesh = generate("sphere", 600).value();
    mesh.attributes.push_back({"NORMAL", ComponentType::f32, 3, false, mesh.attributes[0].data});
    Result<Encoded> encoded = encode(mesh.indices, mesh.vertex_count, {.format = Format::packed, .effort = 0});
    all_written = encoded.has_value() && all_written;
    if (!encoded) return;
    LrFile file = make_lr_file(mesh, std::move(*encoded), false);
    all_written = compress_attributes(file, {.positions = 12, .normals = 9}).has_value() && all_written;
    write("lr_file", "normals-stored", serialize_lr(file, LrForm::stored));
}

/// Packs a scene with all options, to FOLDER/scene/NAME-...
void write_packed_scenes(const std::filesystem::path& source) {
    const auto file = MappedFile::open(source);
    all_written = file.has_value() && all_written;
    if (!file) return;
    for (std::uint32_t way = 0; way < 16; ++way) {
        PackOptions options;
        if (way % 2 == 0) options.bits = {};
        options.keep_order = way / 2 % 2 != 0;
        options.json = way / 4 % 2 != 0 ? SceneJson::packed : SceneJson::plain;
        options.fallback = way / 8 != 0;
        if (options.fallback && options.json == SceneJson::packed) continue;
        const Result<SceneFile> scene = pack_scene(file->bytes(), source, options);
        all_written = scene.has_value() && all_written;
        if (!scene) continue;
        write("scene", source.filename().string() + "-packed-" + std::to_string(way), make_glb_file(*scene).value());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    folder = argv[1];
    for (int i = 2; i < argc; ++i) write_packed_scenes(argv[i]);
    if (argc > 2) return all_written ? 0 : 1;
    std::uint32_t number = 0;
    for (const test::NamedMesh& named : test::named_meshes()) {
        if (named.mesh.triangle_count() <= 200) write_seeds(named.name, named.mesh, number);
        ++number;
    }
    for (const char* kind : {"blob", "terrain", "parts", "soup", "genus"}) {  // of several blocks and groups
        write_seeds(std::string(kind) + "-600", generate(kind, 600).value(), number++);
        write_seeds(std::string(kind) + "-4600", generate(kind, 4600).value(), number++);
    }
    for (const char* kind : {"sphere", "blob", "terrain", "parts", "genus"}) {
        for (const bool normals : {false, true})
            write_stored(std::string(kind) + (normals ? "-normals" : "-texture"), generate(kind, 200).value(), normals);
    }
    write_vertex_seeds();
    write_stored_normals();
    if (!all_written) std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
    return all_written ? 0 : 1;
}
