#pragma once

#include <functional>

namespace selvedge {

// Calls body(i) for 0 <= i < count on all threads, `grain` calls at a time, in any order. The body must not throw.
void parallel_for(int count, int grain, const std::function<void(int)>& body);

bool has_openmp();  // whether the build has OpenMP

// Most threads that a parallel loop uses here: 1 where the build has no OpenMP.
int most_threads();

// From now on parallel loops of the calling thread use at most `count` threads. Without OpenMP it does nothing.
void use_threads(int count);

// use_threads for the lifetime of the object; then the old limit is restored.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count) : before_(most_threads()) { use_threads(count); }
  ~ThreadLimit() { use_threads(before_); }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  int before_;
};

// The number of tasks of `size` items each for `count` items. Sums kept by task do not depend on the number of threads.
constexpr int chunks_of(int count, int size) { return (count + size - 1) / size; }

}  // namespace selvedge
