#include "pipeline/host/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace selvedge {
namespace {

// A signal handler can reach nothing but static storage.
volatile std::sig_atomic_t noted = 0;

void note(int) { noted = 1; }

// A program that `nohup` starts has SIGHUP ignored, and it stays so.
bool ignores(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  action.sa_flags = SA_RESTART;  // a terminal that is closed may send it twice
  if (!ignores(SIGHUP)) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  noted = 0;
  handle(note);
}

InterruptWatch::~InterruptWatch() { handle(SIG_DFL); }

bool InterruptWatch::interrupted() { return noted != 0; }

void ignore_file_limit_signal() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace selvedge
