#include "lrio/scene/scene_stream.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>

#include "lacedring/lacedring.hpp"
#include "lacedring/surface.hpp"
#include "lrio/file/lr_layout.h"
#include "lrio/mesh/read_formats.h"
#include "lrio/scene/part_codes.h"

namespace lacedring::detail {
namespace {

/// Sets one behind the other, and their surfaces.
struct Joined {
    Mesh mesh;
    Surface surface;
    std::vector<std::uint32_t> part_of;  ///< of each triangle
    std::size_t parts = 0;
};

Joined join_sets(std::vector<CodedSet>& sets, bool keep_order) {
    Joined out;
    std::vector<std::uint32_t> vertex_of;
    for (CodedSet& coded : sets) {
        Mesh& mesh = coded.set.mesh;
        Surface surface = find_surface(mesh);
        if (surface.has_seams()) move_to_surface(mesh, surface);
        if (!keep_order) mesh = merge_copies(mesh, surface);
        const std::uint32_t first = out.mesh.vertex_count;
        for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
            vertex_of.push_back(out.surface.vertex_count + (surface.has_seams() ? surface.vertex_of[v] : v));
        }
        out.surface.vertex_count += surface.vertex_count;
        if (out.mesh.attributes.empty()) {
            out.mesh.attributes = std::move(mesh.attributes);
        } else {
            for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
                std::vector<std::byte>& to = out.mesh.attributes[a].data;
                to.insert(to.end(), mesh.attributes[a].data.begin(), mesh.attributes[a].data.end());
            }
        }
        out.mesh.vertex_count += mesh.vertex_count;
        for (const std::uint32_t v : mesh.indices) out.mesh.indices.push_back(first + v);
        for (std::size_t part = 0; part < coded.part_numbers.size(); ++part, ++out.parts) {
            const std::uint32_t triangles = coded.set.first_triangle[part + 1] - coded.set.first_triangle[part];
            out.part_of.insert(out.part_of.end(), triangles, coded.part_numbers[part]);
        }
        mesh = {};
    }
    if (out.surface.vertex_count < out.mesh.vertex_count) out.surface.vertex_of = std::move(vertex_of);
    return out;
}

Result<void> compress(LrFile& file, const std::vector<VertexOptions>& options, unsigned threads) {
    for (std::size_t i = 0; i < file.attributes.size(); ++i) {
        LrAttribute& a = file.attributes[i];
        VertexOptions how = options[i];
        how.threads = threads;
        auto encoded = encode_vertices({a.type, a.components, a.normalized, a.data}, how);
        if (!encoded) {
            if (encoded.error().code != ErrorCode::invalid_argument) return encoded.error();
            continue;  // stays as it lies in memory
        }
        a.words = std::move(encoded->words);
        a.data = {};
    }
    return {};
}

struct StreamChoice {
    LrFile file;
    std::vector<std::byte> bytes;
    std::vector<std::uint32_t> triangle_order;
    std::uint32_t degenerate = 0;
};

Result<StreamChoice> make_choice(const Mesh& mesh, const Surface& surface, const std::vector<VertexOptions>& options,
                                 bool keep_order, unsigned threads) {
    const Mesh bare = surface_mesh(mesh, surface);
    EncodeOptions how;
    how.threads = threads;
    Result<Encoded> encoded = encode(bare.indices, bare.vertex_count, how);
    if (!encoded) return encoded.error();
    StreamChoice out;
    out.triangle_order = encoded->triangle_order;
    out.degenerate = encoded->report.topology.degenerate;
    Result<LrFile> file = make_lr_file(mesh, surface, std::move(*encoded), keep_order);
    if (!file) return file.error();
    out.file = std::move(*file);
    if (auto good = compress(out.file, options, threads); !good) return good.error();
    out.bytes = serialize_lr(out.file);
    return out;
}

}  // namespace

Result<SceneStream> encode_scene_stream(std::vector<CodedSet> sets, bool keep_order, unsigned threads) {
    const std::vector<VertexOptions> options = sets.front().options;
    const bool several = sets.size() > 1;
    Joined joined = join_sets(sets, keep_order);
    Result<StreamChoice> best = make_choice(joined.mesh, joined.surface, options, keep_order, threads);
    if (!best) return best.error();
    if (several) {
        // Parts of one model often meet: their positions are then there once. Where they do not, as of many alike that
        // lie in one another until their nodes move them, joining them is worth nothing.
        const Surface across = find_surface(joined.mesh);
        if (across.vertex_count < joined.surface.vertex_count - joined.surface.vertex_count / 20) {
            Mesh moved = joined.mesh;
            move_to_surface(moved, across);
            Result<StreamChoice> other = make_choice(moved, across, options, keep_order, threads);
            if (other && other->bytes.size() < best->bytes.size()) best = std::move(other);
        }
    }
    SceneStream out;
    out.degenerate = best->degenerate;
    out.file = std::move(best->bytes);
    std::vector<std::uint32_t> parts;
    parts.reserve(best->triangle_order.size());
    for (const std::uint32_t t : best->triangle_order) parts.push_back(joined.part_of[t]);
    if (joined.parts > 1) {
        auto codes = encode_part_codes(parts);
        if (!codes) return codes.error();
        out.parts = std::move(*codes);
    }
    return out;
}

namespace {

class StreamSplitter {
  public:
    StreamSplitter(Mesh mesh, std::span<const std::uint32_t> set_of_part, std::span<const std::uint32_t> vertices)
        : mesh_(std::move(mesh)), set_of_part_(set_of_part), vertices_(vertices) {}

    /// `part_of` has the part of each triangle. `in_order`: vertices are numbered set by set.
    Result<DecodedStream> split(std::span<const std::uint32_t> part_of, bool in_order) {
        out_.sets.resize(vertices_.size());
        out_.parts.resize(set_of_part_.size());
        if (out_.sets.size() == 1 && (vertices_[0] == UINT32_MAX || vertices_[0] == mesh_.vertex_count)) {
            return take_all(part_of);
        }
        place_.assign(mesh_.vertex_count, 0);
        if (auto good = in_order ? take_ranges() : number_vertices(part_of); !good) return good.error();
        for (std::size_t s = 0; s < vertices_.size(); ++s) {
            if (vertices_[s] == UINT32_MAX || vertices_[s] == out_.sets[s].vertices) continue;
            return malformed("{} vertices of a set, where its accessors have {}", out_.sets[s].vertices, vertices_[s]);
        }
        if (auto good = take_triangles(part_of, in_order); !good) return good.error();
        take_attributes(in_order);
        return std::move(out_);
    }

  private:
    /// Of one set: everything as it is.
    Result<DecodedStream> take_all(std::span<const std::uint32_t> part_of) {
        out_.sets[0].vertices = mesh_.vertex_count;
        out_.sets[0].attributes = std::move(mesh_.attributes);
        if (out_.parts.size() == 1) {
            out_.parts[0] = std::move(mesh_.indices);
            return std::move(out_);
        }
        for (std::size_t t = 0; t < part_of.size(); ++t) {
            const auto from = mesh_.indices.begin() + static_cast<std::ptrdiff_t>(3 * t);
            out_.parts[part_of[t]].insert(out_.parts[part_of[t]].end(), from, from + 3);
        }
        return std::move(out_);
    }

    Result<void> take_ranges() {
        std::uint64_t first = 0;
        for (std::size_t s = 0; s < vertices_.size(); ++s) {
            if (vertices_[s] == UINT32_MAX) return malformed("vertices in order, and a set without a count");
            first_.push_back(static_cast<std::uint32_t>(first));
            out_.sets[s].vertices = vertices_[s];
            first += vertices_[s];
            if (first > mesh_.vertex_count) break;
        }
        if (first != mesh_.vertex_count) {
            return malformed("{} vertices, where the accessors have {}", mesh_.vertex_count, first);
        }
        for (std::size_t s = 0; s < vertices_.size(); ++s) {
            for (std::uint32_t v = 0; v < vertices_[s]; ++v) place_[first_[s] + v] = v;
        }
        return {};
    }

    /// A vertex is of the set of its triangles.
    Result<void> number_vertices(std::span<const std::uint32_t> part_of) {
        owner_.assign(mesh_.vertex_count, UINT32_MAX);
        for (std::size_t t = 0; t < part_of.size(); ++t) {
            const std::uint32_t set = set_of_part_[part_of[t]];
            for (std::size_t i = 3 * t; i < 3 * t + 3; ++i) {
                std::uint32_t& owner = owner_[mesh_.indices[i]];
                if (owner != UINT32_MAX && owner != set) return malformed("a vertex of two sets");
                owner = set;
            }
        }
        for (std::uint32_t v = 0; v < mesh_.vertex_count; ++v) {
            if (owner_[v] == UINT32_MAX) return malformed("vertex {} is in no triangle", v);
            place_[v] = out_.sets[owner_[v]].vertices++;
        }
        return {};
    }

    Result<void> take_triangles(std::span<const std::uint32_t> part_of, bool in_order) {
        std::vector<std::size_t> sizes(out_.parts.size(), 0);
        for (const std::uint32_t part : part_of) ++sizes[part];
        for (std::size_t p = 0; p < sizes.size(); ++p) out_.parts[p].reserve(3 * sizes[p]);
        for (std::size_t t = 0; t < part_of.size(); ++t) {
            const std::uint32_t part = part_of[t], set = set_of_part_[part];
            for (std::size_t i = 3 * t; i < 3 * t + 3; ++i) {
                const std::uint32_t v = mesh_.indices[i];
                if (in_order && (v < first_[set] || v - first_[set] >= vertices_[set])) {
                    return malformed("a triangle with another set's vertex");
                }
                out_.parts[part].push_back(place_[v]);
            }
        }
        return {};
    }

    void take_attributes(bool in_order) {
        if (out_.sets.size() == 1) {
            out_.sets[0].attributes = std::move(mesh_.attributes);
            return;
        }
        for (DecodedSet& set : out_.sets) {
            for (const Attribute& a : mesh_.attributes) {
                set.attributes.push_back({a.name, a.type, a.components, a.normalized, {}, a.v_up});
                set.attributes.back().data.resize(set.vertices * a.stride());
            }
        }
        std::size_t set = 0;
        for (std::uint32_t v = 0; v < mesh_.vertex_count; ++v) {
            if (in_order) {
                while (v - first_[set] >= vertices_[set]) ++set;
            } else {
                set = owner_[v];
            }
            for (std::size_t a = 0; a < mesh_.attributes.size(); ++a) {
                const std::size_t stride = mesh_.attributes[a].stride();
                std::memcpy(out_.sets[set].attributes[a].data.data() + place_[v] * stride,
                            mesh_.attributes[a].data.data() + v * stride, stride);
            }
        }
    }

    Mesh mesh_;
    std::span<const std::uint32_t> set_of_part_, vertices_;
    std::vector<std::uint32_t> place_, owner_, first_;
    DecodedStream out_;
};

}  // namespace

Result<DecodedStream> decode_scene_stream(std::span<const std::byte> bytes, std::span<const std::byte> parts,
                                          std::span<const std::uint32_t> set_of_part,
                                          std::span<const std::uint32_t> vertices,
                                          const std::function<Result<void>(const LrContents&)>& check) {
    if (check) {
        const Result<LrContents> contents = list_lr(bytes);
        if (!contents) return contents.error();
        if (auto good = check(*contents); !good) return good.error();
    }
    DecodedLr connectivity;
    const Result<LrFile> file = parse_lr(bytes, connectivity);
    if (!file) return file.error();
    const bool in_order = !file->vertex_order.empty() && !file->corner_order.empty();
    Result<Mesh> mesh = in_order ? decode_lr_original_order(*file) : decode_mesh(*file, connectivity, nullptr);
    if (!mesh) return mesh.error();
    std::vector<std::uint32_t> part_of;
    if (set_of_part.size() > 1 || vertices.size() > 1) part_of.assign(mesh->triangle_count(), 0);
    if (set_of_part.size() > 1) {
        auto codes = decode_part_codes(parts, part_of.size(), set_of_part.size());
        if (!codes) return codes.error();
        part_of = std::move(*codes);
    } else if (!parts.empty()) {
        return malformed("parts of a stream that has one");
    }
    if (in_order && set_of_part.size() > 1) {  // codes are in the stream's order
        std::vector<std::uint32_t> order(part_of.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return file->corner_order[a] < file->corner_order[b]; });
        std::vector<std::uint32_t> sorted;
        sorted.reserve(order.size());
        for (const std::uint32_t i : order) sorted.push_back(part_of[i]);
        part_of = std::move(sorted);
    }
    return StreamSplitter(std::move(*mesh), set_of_part, vertices).split(part_of, in_order);
}

}  // namespace lacedring::detail
