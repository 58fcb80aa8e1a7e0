// The README's example: a mesh to a lean stream and back.
#include <cstdio>
#include <lrcore/lean/lean_stream.h>
#include <lrcore/mesh/read.h>

int main(int argc, char** argv) {
    const lr::Result<lr::Mesh> mesh = lr::read_mesh(argc > 1 ? argv[1] : "");
    if (!mesh) return std::printf("%s\n", mesh.error().message.c_str()), 1;
    const auto table = lr::build_corner_table(mesh->indices, mesh->vertex_count);
    const auto lean = lr::encode_lean(*table, lr::expand_rings(*table));  // lean->words is all there is to store
    const auto view = lr::view_lean(lean->words);
    std::vector<std::uint32_t> indices(std::size_t{3} * view->slots());
    lr::decode_lean(*view, indices);  // over vertices in the order lean->vertex_order
    std::printf("%u triangles in %zu references\n", view->triangles, view->references());
}
