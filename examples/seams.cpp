// A cube with a normal for each face. The operators walk its surface of 8 vertices; each vertex has three copies, one
// for each normal. Counts the sharp edges, then scales the cube and expands vertex positions to the copies for drawing.
#include <array>
#include <cstdio>
#include <lacedring/lacedring.hpp>
#include <lacedring/seams.hpp>

using namespace lacedring;

Result<void> run() {
    const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::uint32_t> indices;
    for (const auto& f : faces) indices.insert(indices.end(), {f[0], f[1], f[2], f[0], f[2], f[3]});
    const Result<Encoded> encoded = encode(indices, 8, {.format = Format::lr});
    if (!encoded) return encoded.error();
    const Result<StreamView> stream = validate(encoded->words);
    if (!stream) return stream.error();

    // Encodes the seams. Corners get arbitrary numbers; corners of a vertex with equal numbers share a copy.
    const std::vector<std::uint32_t> slots = slot_triangles(*stream);
    std::vector<std::uint32_t> numbers(slots.size());
    std::size_t corner = 0;
    for (std::size_t k = 0; k < slots.size(); ++k) {
        if (slots[k] == UINT32_MAX) continue;  // a slot without a triangle
        const std::uint32_t face = encoded->triangle_order[corner++ / 3] / 2;
        numbers[k] = 8 * face + slots[k];
    }
    const Result<EncodedSeams> section = encode_seams(slots, stream->vertices(), numbers);
    if (!section) return section.error();
    std::vector<std::uint32_t> normals;  // of the copies, in their order; here the face's number instead of a vector
    for (const std::uint32_t number : section->copy_order) normals.push_back(number / 8);

    // Walks the surface. The attributes of a corner are those of its copy.
    const Result<SeamView> seams = validate_seams(section->words, slots, stream->vertices());
    if (!seams) return seams.error();
    const auto* tables = stream->get<LrStreamView<LrView>>();
    const Operators ops(tables->view, tables->copies);
    CornerCopies copies(*stream, *seams);
    std::uint32_t sharp = 0;
    for (const VertexId v : IdRange<VertexTag>(stream->vertices())) {
        ops.star(v, [&](CornerId c) {
            const CornerId s = ops.swing(c);  // the corner across the edge; null at a border
            if (!s.is_null() && normals[copies.copy(c)] != normals[copies.copy(s)]) ++sharp;
        });
    }

    // Moves the vertices, then gives each copy the position of its vertex.
    std::vector<std::array<float, 3>> positions, drawn;
    for (const std::uint32_t v : encoded->vertex_order) {
        positions.push_back(
            {2.0F * static_cast<float>(v & 1), static_cast<float>(v & 2), static_cast<float>(v & 4) / 2});
    }
    std::vector<std::uint32_t> vertices(seams->copies);
    copy_vertices(*seams, slots, vertices);
    for (const std::uint32_t v : vertices) drawn.push_back(positions[v]);
    std::printf("%u vertices, %zu copies, %u sharp edges\n", stream->vertices(), drawn.size(), sharp / 2);
    return {};
}

int main() {
    const Result<void> done = run();
    return done ? 0 : (std::puts(done.error().message.c_str()), 1);
}
