#include "app/bench/candidates.h"

#include <algorithm>
#include <iterator>
#include <memory>

#include "app/bench/vertices.h"
#include "lrlab/rivals/codecs.h"
#include "lrlab/rivals/limit.h"
#include "lrlab/rivals/squad.h"
#include "lrlab/rivals/strips.h"

namespace lacedring::app {
namespace {

constexpr std::uint32_t kHybridPeriod = 32;  // of Figure 8's middle picture

Result<CornerTable> build(const Subject& subject) {
    return build_corner_table(subject.mesh.indices, subject.mesh.vertex_count);
}

}  // namespace

Candidates construction(const Subject& subject) {
    const Subject& s = subject;
    Candidates out;
    out.add("corner_table", [&s] { (void)build(s); });
    out.add("ring", [&s] { expand_rings(s.table, s.ring); });
    out.add("lean_encode", [&s] { (void)encode_lean(s.table, s.rings); });
    out.add("lean", [&s] {
        const Result<CornerTable> table = build(s);
        (void)encode_lean(*table, expand_rings(*table, s.ring));
    });
    if (const Result<void> orders = check_valences(s.mesh.indices, s.mesh.vertex_count); orders) {
        out.add("strips", [&s] { (void)make_restart_strip(s.mesh.indices, s.mesh.vertex_count); });
    } else {
        out.absent.emplace_back("strips", orders.error().message);
    }
    out.add("ring_hybrid", [&s] { expand_rings(s.table, {s.ring.seeds, 1, kHybridPeriod}); });
    // From a corner table of a pseudo-manifold to the tables, ring included.
    const auto split = std::make_shared<CornerTable>(s.table);
    split_fans(*split);
    const auto make_lr = [&s, split](std::uint32_t k) {
        return build_lr(*split, expand_rings(*split, {s.ring.seeds, 1, k, true}));
    };
    out.add("lr", [make_lr] { (void)make_lr(0); });
    out.add("lr_compact", [make_lr] {
        if (const auto lr = make_lr(kHybridPeriod)) (void)build_compact_lr(lr->view());
    });
    out.add("squad", [split] { (void)build_squad(*split); });
    // The optimizer alone, at its default, and from index list to packed stream with it.
    out.add("optimize", [&s] { (void)optimize_rings(s.table, s.rings, packed_optimization()); });
    out.add("packed_encode", [&s] { (void)encode_packed(s.table, s.rings); });
    out.add("packed_cache_encode", [&s] { (void)encode_packed(s.table, s.rings, PackedProfile::cache); });
    out.add("packed", [&s] {
        const Result<CornerTable> table = build(s);
        (void)encode_packed(*table, optimize_rings(*table, expand_rings(*table, s.ring), packed_optimization()));
    });
    return out;
}

Result<Candidates> decoding(const Subject& subject, const VertexOptions& positions) {
    const Subject& s = subject;
    /// Memory that the candidates share: inputs and results of decoding.
    struct Buffers {
        std::vector<std::uint32_t> indices, copy, unpacked, decoded;
        CodedIndices codec;
        EncodedSeams seams;
        SeamView seam_view;
    };
    const auto b = std::make_shared<Buffers>();
    b->indices.resize(std::size_t{3} * s.lean_view.slots());
    b->copy.resize(b->indices.size());
    b->unpacked.resize(std::size_t{3} * s.packed_view.triangles);
    b->decoded.resize(b->unpacked.size());
    Candidates out;
    out.add("lean", [&s, b] { decode_lean(s.lean_view, b->indices); });
    out.add("copy", [b] { std::copy(b->indices.begin(), b->indices.end(), b->copy.begin()); });
    out.add("packed", [&s, b] { decode_packed(s.packed_view, b->unpacked); });
    out.add("packed_2_threads", [&s, b] { decode_packed(s.packed_view, b->unpacked, 2); });
    out.add("packed_cache", [&s, b] { decode_packed(s.packed_cache_view, b->unpacked); });

    std::vector<std::uint32_t> proper;  // the rival takes no degenerate triangles
    for (const std::uint32_t t : s.packed.triangle_order) {
        for (std::size_t k = 0; k < 3; ++k) proper.push_back(s.mesh.indices[std::size_t{3} * t + k]);
    }
    if (Result<CodedIndices> codec = encode_meshopt_indices(proper, s.mesh.vertex_count)) {
        b->codec = std::move(*codec);
        out.add("meshopt_index_codec", [b] { (void)decode_meshopt_indices(b->codec.bytes, b->decoded); });
    } else {
        out.absent.emplace_back("meshopt_index_codec", codec.error().message);
    }
    Result<VertexBench> vertices = vertex_candidates(s.mesh, positions, s.packed.vertex_order, b->codec.order);
    if (!vertices) return vertices.error();
    std::ranges::move(vertices->absent, std::back_inserter(out.absent));
    std::ranges::move(vertices->candidates, std::back_inserter(out.list));
    if (!s.loaded.surface.has_seams()) return out;
    Result<EncodedSeams> seams =
        encode_seams(as_encoded(EncodedPacked(s.packed)), s.loaded.mesh.indices, s.loaded.surface.vertex_of);
    if (!seams) return seams.error();
    b->seams = std::move(*seams);
    const Result<SeamView> view = view_seams(b->seams.words, s.packed_view.triangles, s.packed_view.vertices);
    if (!view) return view.error();
    b->seam_view = *view;
    out.add("packed_seams", [&s, b] {
        decode_packed(s.packed_view, b->unpacked);
        decode_seams(b->seam_view, b->unpacked, b->decoded);
    });
    return out;
}

}  // namespace lacedring::app
