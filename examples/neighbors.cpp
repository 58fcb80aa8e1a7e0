// Prints for each triangle of a mesh the neighbor across from each of its corners, all by the mesh's own numbers. The
// operators have numbers of their own: the i-th canonical one is the triangle triangle_order[i] of the mesh, and its
// first corner may be another one.
#include <cstdio>
#include <lacedring/lacedring.hpp>

using namespace lacedring;

int main() {
    const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3, 2, 3, 4};  // a strip of three triangles
    const Result<Encoded> encoded = encode(indices, 5, {.format = Format::lr});
    if (!encoded) return std::puts(encoded.error().message.c_str()), 1;
    const Result<StreamView> stream = validate(encoded->words);
    if (!stream) return std::puts(stream.error().message.c_str()), 1;
    const auto* tables = stream->get<LrStreamView<LrView>>();
    const Operators ops(tables->view, tables->copies);

    // Degenerate triangles are not in the tables: their entries stay null.
    std::vector<TriangleId> number_in_tables(indices.size() / 3, kNullTriangle);
    std::vector<std::uint32_t> number_in_mesh(tables->view.triangle_numbers());
    std::size_t decoded = 0;
    for (const TriangleId t : IdRange<TriangleTag>(tables->view.triangle_numbers())) {
        if (!ops.is_canonical(t)) continue;  // a triangle's second number, or none's
        number_in_mesh[t.value] = encoded->triangle_order[decoded++];
        number_in_tables[number_in_mesh[t.value]] = t;
    }

    for (std::size_t i = 0; i < number_in_tables.size(); ++i) {
        if (number_in_tables[i].is_null()) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c = ops.corner(number_in_tables[i], k), o = ops.opposite(c);  // null across a border
            if (o.is_null()) continue;
            std::printf("triangle %zu, across from vertex %u: triangle %u\n", i,
                        encoded->vertex_order[ops.vertex(c).value], number_in_mesh[ops.triangle(o).value]);
        }
    }
}
