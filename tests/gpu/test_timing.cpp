#include "tests/gpu/gpu_test.h"

using namespace lr;
using namespace lr::test;

TEST_CASE_FIXTURE(GpuTest, "device times are measured, once a repetition") {
    const Mesh mesh = generated("sphere", 20000);
    gpu::TimingOptions options;
    options.repeats = 3;
    options.width = 160;
    options.height = 120;
    const auto times = gpu::measure_device(*context, model_of(mesh), options);
    REQUIRE_MESSAGE(times, times.error().message);
    for (const gpu::Times* t :
         {&times->lean.decode, &times->lean.draw, &times->lean.decode_and_draw, &times->packed.decode,
          &times->packed.draw, &times->packed.decode_and_draw, &times->copy, &times->draw_plain}) {
        REQUIRE(t->size() == 3);
        for (const gpu::Elapsed& e : *t) {
            CHECK(e.wall > 0);
            CHECK(e.gpu.has_value() == context->info().timestamps);
        }
    }
    CHECK(times->index_bytes >= 12 * mesh.triangle_count());
    CHECK(times->device_bytes > times->index_bytes);
}
