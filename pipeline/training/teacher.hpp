#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "pipeline/training/solver_frame.hpp"

namespace selvedge {

// The work of a teacher so far.
struct TeacherTally {
  long targets = 0;    // frames that it made or made the potential of
  double seconds = 0;  // in which it made them
  double waited = 0;   // in which the training waited for it [s]
  double rate() const { return seconds > 0 ? static_cast<double>(targets) / seconds : 0; }  // [1/s]
};

// Makes the solver's frames from states of the pool, in its own thread and in the order in which they were asked for.
// Each depends on its state alone. The thread stops at the end, whatever is still asked for.
class Teacher {
 public:
  Teacher(const TeacherOptions&, const TeacherWork&);
  ~Teacher();
  Teacher(const Teacher&) = delete;
  Teacher& operator=(const Teacher&) = delete;

  // Asks for the frame that the state is about to make, unless that was done before. Puts it into state.taught.
  void ask(RollingState&);
  // Waits for what was asked for. Throws what the solver has thrown.
  const TeacherStep& wait(const RollingState&);
  TeacherTally tally() const;

 private:
  void run();
  TeacherOptions options_;
  TeacherWork work_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::packaged_task<TeacherStep()>> tasks_;
  TeacherTally tally_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace selvedge
