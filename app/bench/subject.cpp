#include "app/bench/subject.h"

#include <utility>

#include "app/cli/progress.h"

namespace lacedring::app {

OptimizeOptions packed_optimization() {
    return {.cost = kPackedRingCost};
}

Result<Subject> make_subject(LoadedMesh loaded, std::uint32_t seeds) {
    Mesh mesh = surface_mesh(loaded.mesh, loaded.surface);
    Result<CornerTable> table = build_corner_table(mesh.indices, mesh.vertex_count);
    if (!table) return table.error();
    Subject out;
    out.loaded = std::move(loaded);
    out.mesh = std::move(mesh);
    out.table = std::move(*table);
    out.ring = {seeds, 1};
    out.rings = expand_rings(out.table, out.ring);
    OptimizeOptions optimize = packed_optimization();
    optimize.progress = progress_bar("optimizing the ring", optimize.passes);
    out.optimized = optimize_rings(out.table, out.rings, optimize);
    Result<EncodedLean> lean = encode_lean(out.table, out.rings);
    if (!lean) return lean.error();
    Result<EncodedPacked> packed = encode_packed(out.table, out.optimized),
                          cache = encode_packed(out.table, out.optimized, PackedProfile::cache);
    if (!packed || !cache) return packed ? cache.error() : packed.error();
    out.lean = std::move(*lean);
    out.packed = std::move(*packed);
    out.packed_cache = std::move(*cache);
    const Result<LeanView> lean_view = view_lean(out.lean.words);
    const Result<PackedView> packed_view = view_packed(out.packed.words),
                             cache_view = view_packed(out.packed_cache.words);
    if (!lean_view || !packed_view || !cache_view)
        return Error{ErrorCode::malformed, "a stream is invalid right after encoding"};
    out.lean_view = *lean_view;
    out.packed_view = *packed_view;
    out.packed_cache_view = *cache_view;
    return out;
}

}  // namespace lacedring::app
