#pragma once

#include <condition_variable>
#include <cstring>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "pipeline/processes/processes.hpp"

namespace selvedge::fake {

// Processes that are threads of this one. One of them runs at a time, in the given order of ranks, until it waits for
// the others: the order stands for who is faster.
class Turns {
 public:
  explicit Turns(std::vector<int> order) : order_(std::move(order)), blocks_(order_.size()), ended_(order_.size()) {}

  // Does the work of every rank. Returns what each has thrown; null: nothing.
  std::vector<std::exception_ptr> run(const std::function<void(Processes&)>& work) {
    std::vector<std::exception_ptr> thrown(order_.size());
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < order_.size(); ++rank)
      threads.emplace_back([&, rank] {
        Member member(*this, rank);
        try {
          work(member);
        } catch (...) {
          thrown[rank] = std::current_exception();
        }
      });
    for (std::thread& thread : threads) thread.join();
    return thrown;
  }

 private:
  using Bytes = std::vector<std::byte>;

  class Member : public Processes {
   public:
    Member(Turns& turns, std::size_t rank) : turns_(turns), rank_(rank), hold_(turns.mutex_) { wait(); }
    ~Member() override {
      turns_.ended_[rank_] = true;
      pass_on();
    }
    int rank() const override { return static_cast<int>(rank_); }
    int count() const override { return static_cast<int>(turns_.order_.size()); }
    void gather(std::span<const std::byte> block, std::span<std::byte> all) override {
      give(block);
      for (std::size_t k = 0; k < turns_.blocks_.size(); ++k) copy(turns_.blocks_[k], 0, block.size(), all, k);
      pass_on();
      wait();  // until all have copied
    }
    void exchange(std::span<const std::byte> blocks, std::span<std::byte> got) override {
      give(blocks);
      const std::size_t size = blocks.size() / turns_.blocks_.size();
      for (std::size_t k = 0; k < turns_.blocks_.size(); ++k) copy(turns_.blocks_[k], rank_, size, got, k);
      pass_on();
      wait();
    }

   private:
    static void copy(const Bytes& from, std::size_t place, std::size_t size, std::span<std::byte> to, std::size_t at) {
      if (from.size() < (place + 1) * size) throw std::logic_error("processes give blocks of different sizes");
      if (size > 0) std::memcpy(to.data() + at * size, from.data() + place * size, size);
    }
    // Comes back when all others have given their blocks.
    void give(std::span<const std::byte> block) {
      turns_.blocks_[rank_].assign(block.begin(), block.end());
      pass_on();
      wait();
      for (const char ended : turns_.ended_)
        if (ended) throw std::logic_error("a process has ended while another one waits for it");
    }
    void pass_on() {
      turns_.turn_ = (turns_.turn_ + 1) % turns_.order_.size();
      turns_.changed_.notify_all();
    }
    std::size_t whose_turn() const { return static_cast<std::size_t>(turns_.order_[turns_.turn_]); }
    // Those that have ended are passed over.
    void wait() {
      turns_.changed_.wait(hold_, [&] {
        while (turns_.ended_[whose_turn()]) pass_on();
        return whose_turn() == rank_;
      });
    }
    Turns& turns_;
    std::size_t rank_;
    std::unique_lock<std::mutex> hold_;
  };

  std::vector<int> order_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t turn_ = 0;
  std::vector<Bytes> blocks_;
  std::vector<char> ended_;
};

}  // namespace selvedge::fake
