#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <thread>

#include "mpc/receding_horizon/receding_horizon.hpp"

namespace wex::app {

/// Runs the optimizer beside the control loop, one solve at a time. A slot that belongs to one side
/// at a time instead of a lock: the control thread never waits for the solver.
class SolverThread {
 public:
  struct Solved {
    HorizonResult result;
    double cpu_time_s = 0.0;  ///< thread CPU time of the solve
  };

  explicit SolverThread(std::function<HorizonResult(const HorizonInput&)> solve);
  SolverThread(const SolverThread&) = delete;
  SolverThread& operator=(const SolverThread&) = delete;
  /// Waits for a solve under way.
  ~SolverThread();

  /// True while a solve is under way or its result was not taken.
  [[nodiscard]] bool busy() const noexcept;
  /// Begins a solve. Not while busy (contract).
  void begin(HorizonInput input);
  /// The result, once; nothing while it is not there. Control thread only.
  ///   throws  what the solve threw
  [[nodiscard]] std::optional<Solved> take();

 private:
  enum class Slot { kEmpty, kInput, kResult, kQuit };
  void work();

  std::function<HorizonResult(const HorizonInput&)> solve_;
  std::atomic<Slot> slot_{Slot::kEmpty};
  std::atomic<bool> quit_{false};
  HorizonInput input_;  ///< the solver's while slot_ is kInput, else the control thread's
  Solved solved_;
  std::exception_ptr problem_;
  std::jthread thread_;  ///< last: begins when all else is there
};

}  // namespace wex::app
