#include "app/bench/device_times.h"
#include "tests/gpu/gpu_test.h"

using namespace lacedring;
using namespace lacedring::test;

namespace {

void check_times(const app::Times& times, bool has_timestamps) {
    INFO("a time per repetition, of the device if it has timestamps");
    REQUIRE(times.size() == 3);
    for (const gpu::Elapsed& e : times) {
        CHECK(e.wall > 0);
        CHECK(e.gpu.has_value() == has_timestamps);
    }
}

void check_bytes(const app::Way& way, std::uint64_t triangles) {
    INFO("the compute path holds an index list, the others the stream alone");
    CHECK(way.connectivity_bytes > triangles / 8);
    CHECK(way.bytes_read > 0);
    if (way.path == gpu::Path::compute) CHECK(way.connectivity_bytes >= 12 * triangles);
    if (way.path != gpu::Path::compute) CHECK(way.connectivity_bytes < 6 * triangles);
    // A tip and one or two flags per slot. The words of warts are read only at warts.
    if (way.name == "lean_geometry") CHECK(way.bytes_read < 9 * triangles);
}

void check_invocations(const app::Way& way, std::uint64_t triangles) {
    INFO("the compute path shades a vertex at most once per corner, the pull path at least");
    if (way.vertex_invocations && way.path == gpu::Path::compute) CHECK(*way.vertex_invocations <= 3 * triangles);
    if (way.vertex_invocations && way.path == gpu::Path::pull) CHECK(*way.vertex_invocations >= 3 * triangles);
}

}  // namespace

TEST_CASE_FIXTURE(GpuTest, "device times are measured once per repetition, with bytes and invocations") {
    const Mesh mesh = generated("sphere", 4000);
    app::TimingOptions options;
    options.repeats = 3;
    options.width = 160;
    options.height = 120;
    const auto model = gpu::make_model(mesh, {.packed = true, .vertices = VertexOptions{}});
    REQUIRE(model);
    const auto times = app::measure_device(*context, *model, options);
    REQUIRE_MESSAGE(times, times.error().message);
    const bool has_timestamps = context->info().timestamps;
    check_times(times->copy, has_timestamps);
    check_times(times->vertices, has_timestamps);
    std::size_t decoded = 0;
    for (const app::Way& way : times->ways) {
        CAPTURE(way.name);
        check_times(way.draw, has_timestamps);
        if (!way.decode.empty()) {
            ++decoded;
            check_times(way.decode, has_timestamps);
            check_times(way.decode_and_draw, has_timestamps);
        }
        check_bytes(way, mesh.triangle_count());
        check_invocations(way, mesh.triangle_count());
    }
    CHECK(decoded == 3);
    const std::size_t paths = context->info().max_mesh_groups != 0 ? 4 : 3;
    CHECK(times->ways.size() == 2 + 3 * paths);
    CHECK(times->index_bytes >= 12 * mesh.triangle_count());
    CHECK(times->device_bytes > times->index_bytes);
}
