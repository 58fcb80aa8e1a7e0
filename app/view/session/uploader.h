#pragma once
// Puts models on the device on a thread of its own, so that the window goes on with what it has.

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

/// Materials on the device, and those that they were made of.
struct UploadedMaterials {
    std::shared_ptr<const Materials> of;  ///< null: one grey material
    std::uint32_t triangles = 0;
    gpu::GpuMaterials device;
};

/// A mesh on the device, with what it points to there.
struct UploadedMesh {
    gpu::ExpandedMesh expanded;
    std::shared_ptr<const UploadedMaterials> materials;  ///< UploadKey::With::materials
};

/// What is put there of a model, and with what beside its triangles.
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
        std::vector<UploadedMesh> meshes;  ///< one a key
        std::optional<Error> error;        ///< then there are none
    };

    /// `wake` is called by the thread when something is done. Errors: kDeviceFailure (no thread, and Vulkan's).
    static Result<std::unique_ptr<Uploader>> create(gpu::Context& context, std::function<void()> wake);
    ~Uploader();  ///< Stops what is being done, and waits for that: it uses the device.
    Uploader(const Uploader&) = delete;
    Uploader& operator=(const Uploader&) = delete;

    /// Queues the job, in the place of the one before it: that one is stopped if it has begun. `expander` must outlive
    /// the job.
    void ask(Job job, gpu::Expander& expander);
    /// Asked for last, and not taken yet.
    bool asked(const Job& job) const;
    /// What was asked for last, once it is done.
    std::optional<Done> take();
    /// Waits until nothing is being done. What is done by then can still be taken.
    void finish();
    /// Stops what is being done for good. False: it still runs after `patience`.
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
    std::optional<Job> next_, last_;  // not begun; asked for and not taken
    std::optional<Done> done_;
    std::atomic<bool> stop_ = false;  // what is being done
    bool working_ = false, quit_ = false;
    std::weak_ptr<const UploadedMaterials> materials_;  // uploaded last; the thread's own
    std::thread thread_;
};

}  // namespace lacedring::view
