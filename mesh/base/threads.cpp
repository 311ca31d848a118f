#include "mesh/base/threads.h"

#include <pthread.h>

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "mesh/base/errors.h"

namespace drape {
namespace {

void breathe() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

// Helpers are threads that take chunks of a loop from the caller. The caller never waits for a helper that
// has not begun a chunk: on a busy machine the caller does the work itself. (There, the barriers of OpenMP
// made the same loops a hundred times slower.)
class Helpers {
 public:
  // Where the system has no room for more threads there are fewer: the caller does their work.
  explicit Helpers(int count) : wanted_(count) {
    try {
      for (int k = 0; k < count; ++k) threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
    }
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
    if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  int wanted() const { return wanted_; }

 private:
  // A loop is known by its generation. The ticket holds the generation and the number of chunks that are
  // still to be taken. A helper that comes late sees that no chunk of its loop is left, or sees another
  // generation. A loop is published only when the loop before it is done, so whatever is read between a
  // ticket with chunks left and the exchange of that ticket belongs to the ticket's loop.
  std::uint32_t publish(int count) {
    count_.store(count, std::memory_order_relaxed);
    const auto generation = static_cast<std::uint32_t>(ticket_.load() >> 32) + 1;
    ticket_.store(std::uint64_t{generation} << 32 | static_cast<std::uint32_t>(count),
                  std::memory_order_release);
    ticket_.notify_all();
    return generation;
  }

  void work(std::uint32_t generation) {
    while (true) {
      std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
      const auto left = static_cast<std::uint32_t>(ticket);
      if (static_cast<std::uint32_t>(ticket >> 32) != generation || left == 0) return;
      const int chunk = count_.load(std::memory_order_relaxed) - static_cast<int>(left);
      const auto f = f_.load(std::memory_order_relaxed);
      const void* context = context_.load(std::memory_order_relaxed);
      if (!ticket_.compare_exchange_weak(ticket, ticket - 1, std::memory_order_acq_rel)) continue;
      try {
        f(context, chunk);
      } catch (...) {  // the first exception goes to the caller when all calls are done
        if (!failed_.exchange(true)) failure_ = std::current_exception();
      }
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
  std::atomic<bool> stop_{false}, failed_{false};
  std::exception_ptr failure_;
  int wanted_;
  std::vector<std::thread> threads_;
};

std::atomic<int> chosen{0};
std::mutex one_loop_at_a_time;
thread_local bool inside_a_loop = false;

std::unique_ptr<Helpers>& helpers_of_process() {
  // They are never destroyed: at the end of the program another thread may be in the middle of a loop.
  static std::unique_ptr<Helpers>& helpers = *new std::unique_ptr<Helpers>;
  // A forked child has none of its parent's threads, so it makes its own. The parent's helpers are released
  // and not destroyed, because their threads cannot be joined in the child.
  static const int registered = pthread_atfork(nullptr, nullptr, [] { (void)helpers.release(); });
  (void)registered;
  return helpers;
}

}  // namespace

int threads() {
  const int count = chosen.load(std::memory_order_relaxed);
  return count > 0 ? count : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void set_threads(int count) {
  if (count < 1)
    throw InputError("threads: " + std::to_string(count) + " is not a number of threads; give 1 or more");
  if (count > most_threads)
    throw InputError("threads: " + std::to_string(count) + " are more than the " +
                     std::to_string(most_threads) + " that there may be");
  chosen = count;
}

void run_in_parallel(int count, void (*f)(const void*, int), const void* context) {
  std::unique_lock lock(one_loop_at_a_time, std::defer_lock);
  // A loop inside another loop, or a loop of a second caller at the same time, is done by its caller alone.
  if (inside_a_loop || !lock.try_lock()) {
    for (int k = 0; k < count; ++k) f(context, k);
    return;
  }
  std::unique_ptr<Helpers>& helpers = helpers_of_process();
  if (!helpers || helpers->wanted() != threads() - 1) {
    helpers.reset();
    helpers = std::make_unique<Helpers>(threads() - 1);
  }
  const struct Inside {
    Inside() { inside_a_loop = true; }
    ~Inside() { inside_a_loop = false; }
  } inside;
  helpers->run(count, f, context);
}

}  // namespace drape
