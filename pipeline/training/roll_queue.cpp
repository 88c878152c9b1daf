#include "pipeline/training/roll_queue.hpp"

#include <algorithm>

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/parallel.hpp"

namespace selvedge {

RollQueue::RollQueue(RollMaker& maker) : maker_(maker), thread_([this] { work(); }) {}

RollQueue::~RollQueue() {
  {
    const std::lock_guard hold(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RollQueue::ask(const RollRequest& request) {
  {
    const std::lock_guard hold(mutex_);
    places_.push_back({request, {}, false});
  }
  changed_.notify_all();
}

Roll RollQueue::take() {
  std::unique_lock hold(mutex_);
  changed_.wait(hold, [this] { return failed_ || (!places_.empty() && places_.front().done); });
  if (failed_) std::rethrow_exception(failed_);
  Roll roll = std::move(places_.front().roll);
  places_.pop_front();
  return roll;
}

std::vector<RollRequest> RollQueue::waiting() const {
  const std::lock_guard hold(mutex_);
  std::vector<RollRequest> requests;
  for (const Place& place : places_) requests.push_back(place.request);
  return requests;
}

void RollQueue::work() {
  restore_standard_arithmetic();
  use_threads(1);  // the other threads train
  std::unique_lock hold(mutex_);
  while (true) {
    const auto next = [this] { return std::ranges::find(places_, false, &Place::done); };
    changed_.wait(hold, [&] { return ends_ || next() != places_.end(); });
    if (ends_) return;
    const RollRequest request = next()->request;
    hold.unlock();
    Roll roll;
    std::exception_ptr failed;
    try {
      const std::lock_guard making(making_);
      roll = make_roll(maker_, request);
    } catch (...) {
      failed = std::current_exception();
    }
    hold.lock();
    if (failed) {
      failed_ = failed;
      changed_.notify_all();
      return;
    }
    const auto place = next();  // places leave only from the front, after they are done
    place->roll = std::move(roll);
    place->done = true;
    changed_.notify_all();
  }
}

}  // namespace selvedge
