#include "app/bench/device_times.h"
#include "tests/gpu/gpu_test.h"

using namespace lacedring;
using namespace lacedring::test;

TEST_CASE_FIXTURE(GpuTest, "device times are measured, once a repetition") {
    const Mesh mesh = generated("sphere", 4000);
    app::TimingOptions options;
    options.repeats = 3;
    options.width = 160;
    options.height = 120;
    const auto model = gpu::make_model(mesh, {.packed = true, .vertices = VertexOptions{}});
    REQUIRE(model);
    const auto times = app::measure_device(*context, *model, options);
    REQUIRE_MESSAGE(times, times.error().message);
    const auto check = [&](const app::Times& t) {
        REQUIRE(t.size() == 3);
        for (const gpu::Elapsed& e : t) {
            CHECK(e.wall > 0);
            CHECK(e.gpu.has_value() == context->info().timestamps);
        }
    };
    check(times->copy);
    check(times->vertices);
    const std::uint64_t corners = 3 * mesh.triangle_count();
    std::size_t decoded = 0;
    for (const app::Way& way : times->ways) {
        CAPTURE(way.name);
        check(way.draw);
        if (!way.decode.empty()) {
            ++decoded;
            check(way.decode);
            check(way.decode_and_draw);
        }
        CHECK(way.connectivity_bytes > mesh.triangle_count() / 8);
        CHECK(way.bytes_read > 0);
        if (way.path == gpu::Path::compute) CHECK(way.connectivity_bytes >= 4 * corners);
        if (way.path != gpu::Path::compute) CHECK(way.connectivity_bytes < 2 * corners);
        // A tip and a flag or two a slot: words that no wart needs are not read for it.
        if (way.name == "lean_geometry") CHECK(way.bytes_read < 9 * mesh.triangle_count());
        if (way.vertex_invocations && way.path == gpu::Path::compute) CHECK(*way.vertex_invocations <= corners);
        if (way.vertex_invocations && way.path == gpu::Path::pull) CHECK(*way.vertex_invocations >= corners);
    }
    CHECK(decoded == 3);
    const std::size_t paths = context->info().max_mesh_groups != 0 ? 4 : 3;
    CHECK(times->ways.size() == 2 + 3 * paths);
    CHECK(times->index_bytes >= 12 * mesh.triangle_count());
    CHECK(times->device_bytes > times->index_bytes);
}
