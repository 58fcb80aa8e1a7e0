#pragma once
// Reads, encodes and measures on a thread of its own. The newest request is the one that counts: it ends what is being
// done for an older one.

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/view/document.h"

namespace lr::view {

class Loader {
  public:
    /// `wake` is called by the thread when there is news.
    explicit Loader(std::function<void()> wake);
    ~Loader();  ///< ends what is being done, and waits for that
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// Reads a file. What it gives comes one by one: the mesh with a quick ring, then with the optimised one and the
    /// packed stream, then tables, then formats.
    void open(const Input& input, const RingSettings& settings);
    /// Makes another ring over the same mesh.
    void encode(std::shared_ptr<const Document> document, const RingSettings& settings);
    void cancel();

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
        std::optional<std::string> error;  ///< one line, with the file's name
    };
    News take();
    bool has_news() const;

  private:
    struct Request {
        std::optional<Input> input;
        std::shared_ptr<const Document> document;
        RingSettings settings;
    };
    void run();
    void work(const Request& request);
    Result<void> finish(Document& document, const Request& request, bool quick);
    bool stopped() const { return stop_.load(); }
    double since_asked() const;  ///< seconds
    void say(const std::string& what, double share, bool background = false);
    void publish(const Document& document);
    void request(Request request);

    std::function<void()> wake_window_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<Request> next_;
    News news_;
    Progress progress_;
    std::chrono::steady_clock::time_point asked_{};
    std::atomic<bool> stop_ = false;
    bool quit_ = false;
    std::weak_ptr<const Mesh> measured_;  // whose formats were; of the thread alone
    std::thread thread_;
};

}  // namespace lr::view
