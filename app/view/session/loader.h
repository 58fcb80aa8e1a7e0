#pragma once
// Reads, encodes and measures on threads beside the window's. The newest request is the one that counts: it stops the
// one before it, and does not wait for a disk that the one before it waits for.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/view/session/document.h"
#include "app/view/session/threads.h"

namespace lacedring::view {

class Loader {
  public:
    /// `wake` is called, by other threads, when there is news; not after the loader is gone.
    Loader(Threads& threads, std::function<void()> wake);
    ~Loader();  ///< Stops what is being done, without waiting for it.
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// Reads a file. What it gives comes one by one: the mesh with a quick ring, then with the optimised one and the
    /// packed stream, then tables, then formats.
    void open(const Input& input, const RingSettings& settings);
    /// Makes another ring over the same mesh.
    void encode(std::shared_ptr<const Document> document, const RingSettings& settings);
    void cancel();
    /// Lists the meshes in the folder of `path`: a folder may be as slow as a file.
    void list(const std::string& path);

    struct Progress {
        bool busy = false;
        bool background = false;  ///< what is being done keeps nobody waiting
        std::string what;
        double share = 0;
    };
    Progress progress() const;

    /// What has come since the last call.
    struct News {
        std::shared_ptr<const Document> document;
        std::shared_ptr<const Tables> tables;
        std::shared_ptr<const app::FormatSet> formats;
        std::optional<std::vector<std::string>> files;  ///< of the folder listed last
        std::optional<std::string> error;               ///< one line, with the file's name
    };
    News take();
    bool has_news() const;

  private:
    struct Request {
        std::optional<Input> input;
        std::shared_ptr<const Document> document;
        RingSettings settings;
    };
    struct Shared;
    class Job;
    void request(Request request);

    Threads& threads_;
    std::shared_ptr<Shared> shared_;  // with the threads
};

}  // namespace lacedring::view
