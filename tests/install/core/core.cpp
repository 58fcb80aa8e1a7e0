// A tetrahedron there and back by every format, and its operators, with the core alone.
#include <cstdio>
#include <lacedring/lacedring.hpp>
#include <lacedring/operators.hpp>
#include <lacedring/streams.hpp>
#include <vector>

int main() {
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
    const auto table = lacedring::build_corner_table(indices, 4);
    if (!table) return std::puts(table.error().message.c_str()), 1;
    const auto lean = lacedring::encode_lean(*table, lacedring::expand_rings(*table));
    const auto packed = lacedring::encode_packed(*table, lacedring::expand_rings(*table));
    const auto tables = lacedring::encode_lr(*table, {});
    if (!lean || !packed || !tables) return std::puts("not encoded"), 1;

    const auto lean_view = lacedring::validate_lean(lean->words);
    const auto packed_view = lacedring::validate_packed(packed->words);
    const auto lr_view = lacedring::validate_lr(tables->words);
    if (!lean_view || !packed_view || !lr_view) return std::puts("not valid"), 1;
    if (lacedring::decode_lr(*lr_view).size() != indices.size()) return std::puts("not all triangles"), 1;
    std::vector<std::uint32_t> out(3 * lean_view->slots());
    lacedring::decode_lean(*lean_view, out);
    out.resize(3 * packed_view->triangles);
    lacedring::decode_packed(*packed_view, out);
    std::printf("%u triangles\n", packed_view->triangles);
}
