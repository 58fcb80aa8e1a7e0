#include "lrcore/codec/storage/seam_storage.h"

#include <algorithm>
#include <bit>

#include "lrcore/base/message.h"
#include "lrcore/codec/seams/seam_encoder.h"
#include "lrcore/codec/storage/seam_walk.h"

namespace lacedring::storage {
namespace {

/// Codes the table of a section whose answers are known. Likely values and classes are predicted from the counts of
/// answers: unused contexts usually have default entries, and a context's class depends on the frequency of its
/// unlikely answers.
template <class Coder>
SeamTable code_table(Coder& coder, const SeamAnswers& vertices, const SeamAnswers& corners, SeamTable table) {
    std::array<std::array<std::uint32_t, 2>, kSeamContexts> counts{};
    for (const SeamAnswers* answers : {&vertices, &corners}) {
        for (const SeamAnswer& answer : answers->all) {
            if (answer.context < kSeamContexts) ++counts[answer.context][answer.value];
        }
    }
    constexpr std::uint32_t kRarities = 7;
    BitModel is_usual[2], classes[kRarities][8];
    for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
        const auto& [zeros, ones] = counts[c];
        const bool is_asked = zeros + ones > 0, usual = ones > zeros;
        const bool likely = usual != coder.bit(is_usual[is_asked ? 1 : 0], usual != (table.likely[c] != 0));
        table.likely[c] = likely ? 1 : 0;
        const std::uint32_t rare = counts[c][likely ? 0 : 1];
        const auto ratio = rare == 0 ? 0U : static_cast<std::uint32_t>(std::bit_width((zeros + ones) / rare));
        const std::uint32_t rarity = !is_asked ? 0 : rare == 0 ? 1 : std::min(1 + ratio, kRarities - 1);
        std::uint32_t node = 1;
        for (std::uint32_t bit = 3; bit-- > 0;) {
            node = 2 * node + (coder.bit(classes[rarity][node], (table.run_class[c] >> bit & 1) != 0) ? 1 : 0);
        }
        table.run_class[c] = static_cast<std::uint8_t>(node - 8);
    }
    return table;
}

SeamTable table_of(std::span<const std::uint32_t> section) {
    SeamTable out;
    for (std::uint32_t c = 0; c < kSeamContexts; ++c) {
        const std::uint32_t entry = section[4 + c / 8] >> 4 * (c % 8);
        out.likely[c] = entry & 1;
        out.run_class[c] = entry >> 1 & 7;
    }
    return out;
}

/// Renumbers the walk's copies as in the section, and sets the vertex of each copy.
void number_copies(std::span<const std::uint32_t> order, std::span<const std::uint32_t> triangles, std::uint32_t count,
                   RestoredSeams& seams) {
    std::vector<std::uint32_t> number(count);
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        if (order[i] != UINT32_MAX) number[order[i]] = i;
    }
    seams.vertices.resize(order.size());
    for (std::size_t c = 0; c < triangles.size(); ++c) {
        if (triangles[c] == UINT32_MAX) continue;
        seams.copies[c] = number[seams.copies[c]];
        seams.vertices[seams.copies[c]] = triangles[c];
    }
    // Copies of vertices without corners, each after a home of the previous vertex.
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (order[i] == UINT32_MAX) seams.vertices[i] = i == 0 ? 0 : seams.vertices[i - 1] + 1;
    }
}

Error malformed_seams(const char* what) {
    return {ErrorCode::malformed, detail::message("stored seam section: ", what)};
}

}  // namespace

std::optional<std::vector<std::uint32_t>> store_seams(const SeamView& view, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> copies(triangles.size());
    decode_seams(view, triangles, copies);
    const VertexCorners corners(triangles, view.vertices);
    BitEncoder coder;
    SeamWalk<BitEncoder> walk(coder, triangles, view.vertices, corners, copies, view.copies);
    walk.run();
    const auto choose = [&](const SeamAnswers& of_vertices, const SeamAnswers& of_corners) {
        return code_table(coder, of_vertices, of_corners, table_of(view.words));
    };
    const SeamWords made = write_seams({triangles, view.vertices, walk.copies(), walk.count()}, corners, choose, true);
    std::vector<std::uint32_t> out = coder.finish();
    if (!std::ranges::equal(made.words, view.words)) return {};
    const auto restored = restore_seams(out, triangles, view.vertices);
    if (!restored || restored->words != made.words) return {};
    return out;
}

Result<RestoredSeams> restore_seams(std::span<const std::uint32_t> stored, std::span<const std::uint32_t> triangles,
                                    std::uint32_t vertices) {
    constexpr std::uint32_t kNone = UINT32_MAX;
    const Error too_large{ErrorCode::too_large, "stored seam section: more than 2^30 copies, or 4 GiB"};
    if (triangles.size() % 3 != 0) return malformed_seams("invalid number of corners");
    if (vertices > LACEDRING_SEAMS_MAX_COPIES || triangles.size() > UINT32_MAX - vertices) return too_large;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
        if ((a & b & c) == kNone) continue;
        if (std::max({a, b, c}) >= vertices || a == b || b == c || c == a) {
            return malformed_seams("a triangle has a vertex out of range or a repeated vertex");
        }
    }
    BitDecoder coder(stored);
    const VertexCorners corners(triangles, vertices);
    SeamWalk<BitDecoder> walk(coder, triangles, vertices, corners);
    if (!walk.run()) return malformed_seams("a copy is invalid");
    if (walk.count() > LACEDRING_SEAMS_MAX_COPIES) return too_large;
    const auto choose = [&](const SeamAnswers& of_vertices, const SeamAnswers& of_corners) {
        return code_table(coder, of_vertices, of_corners, {});
    };
    SeamWords made = write_seams({triangles, vertices, walk.copies(), walk.count()}, corners, choose, true);
    if (!coder.is_at_end()) return malformed_seams("it does not end after its copies");
    if (made.words.empty()) return too_large;
    RestoredSeams out{std::move(made.words), walk.take_copies(), {}};
    number_copies(made.order, triangles, walk.count(), out);
    return out;
}

}  // namespace lacedring::storage
