// A tetrahedron there and back by every format, and its operators, with the core alone.
#include <lrcore/codec/lean/lean_encode.h>
#include <lrcore/codec/lean/lean_stream.h>
#include <lrcore/codec/packed/packed_encode.h>
#include <lrcore/codec/packed/packed_stream.h>
#include <lrcore/codec/tables/lr_encode.h>
#include <lrcore/codec/tables/operators.h>

#include <cstdio>
#include <vector>

int main() {
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
    const auto table = lr::build_corner_table(indices, 4);
    if (!table) return std::puts(table.error().message.c_str()), 1;
    const auto lean = lr::encode_lean(*table, lr::expand_rings(*table));
    const auto packed = lr::encode_packed(*table, lr::expand_rings(*table));
    const auto tables = lr::encode_lr(*table, {});
    if (!lean || !packed || !tables) return std::puts("not encoded"), 1;

    const auto lean_view = lr::validate_lean(lean->words);
    const auto packed_view = lr::validate_packed(packed->words);
    const auto lr_view = lr::validate_lr(tables->words);
    if (!lean_view || !packed_view || !lr_view) return std::puts("not valid"), 1;
    if (lr::decode_lr(*lr_view).size() != indices.size()) return std::puts("not all triangles"), 1;
    std::vector<std::uint32_t> out(3 * lean_view->slots());
    lr::decode_lean(*lean_view, out);
    out.resize(3 * packed_view->triangles);
    lr::decode_packed(*packed_view, out);
    std::printf("%u triangles\n", packed_view->triangles);
}
