#pragma once
// Uploads models to the device on a thread of its own, so that the window can draw meanwhile.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/view/session/document.h"
#include "renderer/decode/expander.h"
#include "renderer/mesh/gpu_materials.h"

namespace lacedring::view {

/// Materials on the device, and their source.
struct UploadedMaterials {
    std::shared_ptr<const Materials> of;  ///< null: one gray material
    std::uint32_t triangles = 0;
    gpu::GpuMaterials device;
};

/// A mesh on the device, with the materials it points to.
struct UploadedMesh {
    gpu::ExpandedMesh expanded;
    std::shared_ptr<const UploadedMaterials> materials;  ///< UploadKey::With::materials
};

/// Which form of a model is uploaded: source, path, and data besides its triangles.
struct UploadKey {
    enum class With {
        ring,      ///< ring order, classes and the ring's lines
        offsets,   ///< sizes of offsets
        edges,     ///< all edges
        seams,     ///< seams
        materials  ///< materials and textures
    };
    gpu::Source source = gpu::Source::plain;
    gpu::Path path = gpu::Path::compute;
    With with = With::ring;

    auto operator<=>(const UploadKey&) const = default;
};

class Uploader {
  public:
    struct Job {
        std::shared_ptr<const OwningModel> model;
        std::vector<UploadKey> keys;

        bool operator==(const Job&) const = default;
    };
    struct Done {
        Job job;
        std::vector<UploadedMesh> meshes;  ///< one per key; empty after an error
        std::optional<Error> error;
    };

    /// `wake` is called by the thread when a job is done. Errors: kDeviceFailure (no thread; Vulkan).
    static Result<std::unique_ptr<Uploader>> create(gpu::Context& context, std::function<void()> wake);
    /// Stops the current job and waits for the thread, which uses the device.
    ~Uploader();
    Uploader(const Uploader&) = delete;
    Uploader& operator=(const Uploader&) = delete;

    /// Queues the job; drops a queued job and stops a running one. `expander` must outlive the job.
    void ask(Job job, gpu::Expander& expander);
    /// Returns whether this job was asked for last, and its result was not taken yet.
    bool asked(const Job& job) const;
    /// Takes the result of the job asked for last, if it is done.
    std::optional<Done> take();
    /// Waits until no job is queued or running. A result can still be taken afterwards.
    void finish();
    /// Stops the uploader for good. Returns false if a job still runs after `patience`.
    bool stop(std::chrono::milliseconds patience);

  private:
    Uploader(gpu::Context& context, gpu::Transfer transfer, std::function<void()> wake)
        : context_(context), transfer_(std::move(transfer)), wake_(std::move(wake)) {}
    void run();
    Result<void> upload(Done& done, gpu::Expander& expander);
    Result<std::shared_ptr<const UploadedMaterials>> materials_of(const OwningModel& model);

    gpu::Context& context_;
    gpu::Transfer transfer_;
    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    gpu::Expander* expander_ = nullptr;
    std::optional<Job> next_;  // the queued job
    std::optional<Job> last_;  // the job asked for last; empty once its result was taken
    std::optional<Done> done_;
    std::atomic<bool> stop_ = false;  // stops the running job
    bool working_ = false, quit_ = false;
    std::weak_ptr<const UploadedMaterials> materials_;  // uploaded last; used only by the thread
    std::thread thread_;
};

}  // namespace lacedring::view
