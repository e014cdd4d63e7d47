#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/export/product_shape.h"
#include "app/import/import_job.h"
#include "core/import/step_request.h"

namespace nearfit::exporter {

/// Files of exact surfaces for the shapes of a request. They are opened before the sandbox closes and read within it.
class ExactSources {
 public:
  /// Opens the files. One that is gone, or has changed since its shapes were imported, gets a note, and its shapes have no
  /// exact geometry.
  /// @param request  Kept by reference.
  explicit ExactSources(const StepRequest& request);

  /// Bytes of all files, unpacked.
  std::uint64_t bytes() const;
  /// Reads the files. What cannot be read gets a note.
  /// @param progress  Gets the fraction done.
  void read(const std::function<void(double fraction)>& progress);

  /// The exact geometry of a shape; std::nullopt if it has none. To be called once for each shape.
  std::optional<ProductShape> take(std::size_t shape) { return std::move(found_[shape]); }
  /// Sentences for the user.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// A file, and which shapes of the request are in it.
  struct Opened {
    importer::ImportJob job;
    std::vector<std::size_t> shapes;
  };

  void readOne(Opened& opened);

  const StepRequest& request_;
  std::vector<Opened> files_;
  std::vector<std::optional<ProductShape>> found_;  ///< By shape.
  std::vector<std::string> notes_;
};

}  // namespace nearfit::exporter
