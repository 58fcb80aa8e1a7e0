// Smooths a mesh: each vertex moves to the average of its neighbors. Neighbors and positions are read in place from the
// memory-mapped file (lacedring encode MESH --format lr -o IN.lr), without an index list or half-edges.
#include <cstdio>
#include <lacedring/file.hpp>
#include <lacedring/lr_file.hpp>
#include <lacedring/mesh_files.hpp>

using namespace lacedring;

Result<Mesh> smooth(const char* path) {
    const Result<MappedFile> mapped = MappedFile::open(path);
    if (!mapped) return mapped.error();
    const Result<LrFileView> file = view_lr_file(mapped->bytes());
    if (!file) return file.error();
    const Result<StreamView> stream = file->validate();
    if (!stream) return stream.error();
    const auto* tables = stream->get<LrStreamView<LrView>>();
    if (tables == nullptr) return Error{ErrorCode::unsupported, "not --format lr"};

    const Operators ops(tables->view, tables->copies);
    const Positions positions = file->positions();
    std::vector<float> moved;
    for (const VertexId v : IdRange<VertexTag>(stream->vertices())) {
        Point sum{};
        double count = 0;
        ops.neighbors(v, [&](VertexId u) {
            for (std::size_t i = 0; i < 3; ++i) sum[i] += positions[u][i];
            ++count;
        });
        if (count == 0 || ops.is_border(v)) sum = positions[v], count = 1;  // border vertices do not move
        for (const double x : sum) moved.push_back(static_cast<float>(x / count));
    }

    Mesh mesh;
    mesh.vertex_count = stream->vertices();
    mesh.indices = decode(*stream);
    const auto bytes = std::as_bytes(std::span(moved));
    mesh.attributes.push_back({.name = "POSITION", .data = {bytes.begin(), bytes.end()}});
    return mesh;
}

int main(int argc, char** argv) {
    if (argc != 3) return std::puts("adjacency IN.lr OUT.ply|.obj|.glb"), 1;
    const Result<Mesh> mesh = smooth(argv[1]);
    if (!mesh) return std::puts(mesh.error().message.c_str()), 1;
    const Result<void> written = write_mesh(*mesh, argv[2]);
    return written ? 0 : (std::puts(written.error().message.c_str()), 1);
}
