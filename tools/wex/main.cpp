#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string_view>

#include "tools/wex/cli.hpp"

namespace {

/// Ipopt's OpenBLAS starts its threads when it is loaded, before main: the number of threads can
/// only be set for a new process image.
void restart_single_threaded(char** argv) {
  constexpr const char* kVariable = "OPENBLAS_NUM_THREADS";
  const char* threads = std::getenv(kVariable);
  if (threads && std::string_view(threads) == "1") return;
  if (setenv(kVariable, "1", 1) == 0) execv("/proc/self/exe", argv);
  // Without /proc the program goes on: the threads cost time, not correctness.
}

}  // namespace

int main(int argc, char** argv) {
  restart_single_threaded(argv);
  try {
    return wex::app::run_cli(argc, argv, std::cout, std::cerr);
  } catch (const std::exception& exception) {
    std::cerr << "wex: internal error: " << exception.what() << "\n";
    return 1;
  }
}
