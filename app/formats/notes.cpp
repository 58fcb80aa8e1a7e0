#include "app/formats/notes.h"

#include <algorithm>

namespace lacedring::app {

FormatNote note_on(std::string_view format) {
    struct Named {
        std::string_view name;
        FormatNote note;
    };
    static constexpr Named kNotes[] = {
        {"index_u32", {Origin::baseline, "index list, 32-bit"}},
        {"index_u16", {Origin::baseline, "index list, 16-bit"}},
        {"strip_restart", {Origin::baseline, "meshoptimizer’s strips, with restart"}},
        {"strip_degenerate", {Origin::baseline, "the same joined into one strip"}},
        {"lean", {Origin::ours, "one reference per triangle"}},
        {"lean_no_warts", {Origin::ours, "lean without wart skipping"}},
        {"lr", {Origin::paper, "LR tables, all operators"}},
        {"lr_compact", {Origin::paper, "bit-efficient LR tables, all operators"}},
        {"packed", {Origin::ours, "blocks of 256 triangles that decode alone"}},
        {"packed_cache", {Origin::ours, "the same, in an order for the vertex cache"}},
        {"meshopt_index_codec", {Origin::baseline, "meshoptimizer’s codec, decoded sequentially"}},
        {"meshlets", {Origin::baseline, "of 64 vertices and 124 triangles"}},
        {"winged_edge", {Origin::baseline, "all operators"}},
        {"corner_table", {Origin::baseline, "V, O and C; all operators"}},
        {"squad", {Origin::baseline, "SQuad, all operators"}},
    };
    const auto* found = std::ranges::find(kNotes, format, &Named::name);
    return found == std::end(kNotes) ? FormatNote{Origin::baseline, ""} : found->note;
}

}  // namespace lacedring::app
