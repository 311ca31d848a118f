#include "mesh/threads.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mesh/obj.h"

namespace drape {
namespace {

void breathe() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

// Helpers that take chunks of a loop from the caller. The caller never waits for a helper that has not begun
// a chunk: on a busy machine it does the work itself (with OpenMP's barriers the same loops were a hundred
// times slower there).
class Helpers {
 public:
  explicit Helpers(int count) {
    for (int k = 0; k < count; ++k) threads_.emplace_back([this] { serve(); });
  }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;
  ~Helpers() {
    stop_ = true;
    publish(0);
    for (std::thread& thread : threads_) thread.join();
  }

  void run(int count, void (*f)(const void*, int), const void* context) {
    f_.store(f, std::memory_order_relaxed);
    context_.store(context, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    work(publish(count));
    while (done_.load(std::memory_order_acquire) < count) breathe();
  }

  int count() const { return static_cast<int>(threads_.size()); }

 private:
  // A loop is known by its generation; the ticket is the generation and the next chunk, so that a helper that
  // comes late, when the next loop has been published, cannot take a chunk in the name of the old one.
  std::uint32_t publish(int count) {
    count_.store(count, std::memory_order_relaxed);
    const auto generation = static_cast<std::uint32_t>(ticket_.load() >> 32) + 1;
    ticket_.store(std::uint64_t{generation} << 32, std::memory_order_release);
    ticket_.notify_all();
    return generation;
  }

  void work(std::uint32_t generation) {
    while (true) {
      std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
      const auto chunk = static_cast<std::uint32_t>(ticket);
      if (static_cast<std::uint32_t>(ticket >> 32) != generation) return;
      if (static_cast<int>(chunk) >= count_.load(std::memory_order_relaxed)) return;
      const auto f = f_.load(std::memory_order_relaxed);
      const void* context = context_.load(std::memory_order_relaxed);
      if (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel)) continue;
      f(context, static_cast<int>(chunk));
      done_.fetch_add(1, std::memory_order_release);
    }
  }

  void serve() {
    constexpr int patience = 4000;  // some ten microseconds: the next loop of a solve comes sooner
    std::uint32_t seen = 0;
    int idle = 0;
    while (!stop_) {
      const std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
      if (const auto generation = static_cast<std::uint32_t>(ticket >> 32); generation != seen) {
        work(generation);
        seen = generation;
        idle = 0;
      } else if (++idle < patience) {
        breathe();
      } else {
        ticket_.wait(ticket);
        idle = 0;
      }
    }
  }

  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<void (*)(const void*, int)> f_{nullptr};
  std::atomic<const void*> context_{nullptr};
  std::atomic<int> count_{0}, done_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

std::atomic<int> chosen{0};
std::mutex one_loop_at_a_time;
thread_local bool inside_a_loop = false;

}  // namespace

int threads() {
  const int count = chosen.load(std::memory_order_relaxed);
  return count > 0 ? count : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void set_threads(int count) {
  if (count < 1)
    throw InputError("threads: " + std::to_string(count) + " is not a number of threads; give 1 or more");
  chosen = count;
}

void run_in_parallel(int count, void (*f)(const void*, int), const void* context) {
  static std::unique_ptr<Helpers> helpers;
  std::unique_lock lock(one_loop_at_a_time, std::defer_lock);
  // A loop within a loop, or of a second caller at the same time, is done by its caller alone.
  if (inside_a_loop || !lock.try_lock()) {
    for (int k = 0; k < count; ++k) f(context, k);
    return;
  }
  if (!helpers || helpers->count() != threads() - 1) {
    helpers.reset();
    helpers = std::make_unique<Helpers>(threads() - 1);
  }
  inside_a_loop = true;
  helpers->run(count, f, context);
  inside_a_loop = false;
}

}  // namespace drape
