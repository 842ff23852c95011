#include "tools/wex/solver_thread.hpp"

#include <exception>
#include <utility>

#include "models/types/cpu_clock.hpp"

namespace wex::app {

SolverThread::SolverThread(std::function<HorizonResult(const HorizonInput&)> solve)
    : solve_(std::move(solve)), thread_([this] { work(); }) {}

SolverThread::~SolverThread() {
  quit_ = true;
  // A worker that waits is woken; one that solves finds quit_ afterwards.
  Slot slot = slot_;
  if (slot != Slot::kInput && slot_.compare_exchange_strong(slot, Slot::kQuit)) slot_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool SolverThread::busy() const noexcept { return slot_ != Slot::kEmpty; }

void SolverThread::begin(HorizonInput input) {
  WEX_EXPECTS(!busy());
  input_ = std::move(input);
  slot_ = Slot::kInput;
  slot_.notify_one();
}

std::optional<SolverThread::Solved> SolverThread::take() {
  if (slot_ != Slot::kResult) return std::nullopt;
  Solved solved = std::exchange(solved_, {});
  const std::exception_ptr problem = std::exchange(problem_, nullptr);
  slot_ = Slot::kEmpty;
  slot_.notify_one();
  if (problem) std::rethrow_exception(problem);
  return solved;
}

void SolverThread::work() {
  for (;;) {
    Slot slot = slot_;
    while (slot == Slot::kEmpty || slot == Slot::kResult) {
      slot_.wait(slot);
      slot = slot_;
    }
    if (slot == Slot::kQuit) return;
    const double begin_s = thread_cpu_time_s();
    try {
      solved_.result = solve_(input_);
    } catch (...) {
      problem_ = std::current_exception();
    }
    solved_.cpu_time_s = thread_cpu_time_s() - begin_s;
    slot_ = Slot::kResult;
    if (quit_) return;
  }
}

}  // namespace wex::app
