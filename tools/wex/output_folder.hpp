#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "models/types/result.hpp"

namespace wex::app {

/// The folder a run reports into. Files appear whole or not at all (written under a temporary name,
/// then renamed). Folders it had to create go away again if nothing was put into them.
class OutputFolder {
 public:
  /// Creates the folder and proves that it can be written.
  ///   errors  kBadInput naming the folder and the system's reason
  [[nodiscard]] static Result<OutputFolder> open(const std::filesystem::path& folder);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return folder_; }
  /// Removes what an earlier run left under these names, so that no two runs mix.
  void remove_stale(const std::vector<std::string>& names) const;
  /// `write` produces the file at the temporary path it is given; only its success is published.
  ///   name    relative to the folder; sub-folders are created
  [[nodiscard]] Result<void> publish(
      const std::string& name,
      const std::function<Result<void>(const std::filesystem::path&)>& write) const;
  [[nodiscard]] Result<void> publish_text(const std::string& name, const std::string& text) const;

 private:
  OutputFolder() = default;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> created_;  ///< outermost first
};

/// Writes a text file whole or not at all.
[[nodiscard]] Result<void> write_text_file(const std::filesystem::path& file,
                                           const std::string& text);

}  // namespace wex::app
