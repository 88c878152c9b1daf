#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "pipeline/training/training_roll.hpp"

namespace selvedge {

// Prepares roll-outs in its own thread, in the order of the requests. The result depends on the requests only, not on
// time.
class RollQueue {
 public:
  explicit RollQueue(RollMaker&);  // only the thread may use the maker until the queue ends, except in `locked`
  ~RollQueue();
  RollQueue(const RollQueue&) = delete;
  RollQueue& operator=(const RollQueue&) = delete;

  void ask(const RollRequest&);
  // Waits until the first request is prepared, and takes it. Throws the error of its preparation.
  Roll take();
  // The requests that were not taken, the first one first.
  std::vector<RollRequest> waiting() const;
  // Runs `work` while nothing is being prepared.
  template <class Work>
  void locked(const Work& work) {
    const std::lock_guard hold(making_);
    work();
  }

 private:
  struct Place {
    RollRequest request;
    Roll roll;
    bool done = false;
  };
  void work();
  RollMaker& maker_;
  mutable std::mutex mutex_;
  std::mutex making_;
  std::condition_variable changed_;
  std::deque<Place> places_;
  std::exception_ptr failed_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace selvedge
