#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/picture/scene_picture.h"
#include "core/report/html/fit_report.h"
#include "core/report/html/report_page_writer.h"

namespace nearfit {

/// A picture of a report's page.
struct ReportPicture {
  ScenePicture scene;
  int width, height;     ///< [pixels]
  std::string png = {};  ///< Bytes of a PNG file.
};

/// Pictures of a finding, by index among those of the page.
struct PicturedFinding {
  const ComparedFinding* finding;
  std::size_t whole;
  std::optional<std::size_t> close;
};

/// A side that a report shows the scene from.
struct ReportSide {
  PictureSide side;
  const char* caption;
};
inline constexpr std::array kReportSides{
    ReportSide{PictureSide::Isometric, "Isometric: from the right, the front and above."},
    ReportSide{PictureSide::Front, "Front: along +y; x to the right, z up."},
    ReportSide{PictureSide::Right, "Right: along -x; y to the right, z up."},
    ReportSide{PictureSide::Top, "Top: along -z; x to the right, y up."}};

/// All pictures of a report's page.
struct ReportPictures {
  std::vector<ReportPicture> all;  ///< Those of kReportSides, then those of findings.
  std::vector<PicturedFinding> findings;
};

/// Draws the scene from all sides, and the first FitReportRequest::maxPictured findings of those that the check found now. On
/// all processors. Throws Cancelled.
/// @param rows  Findings of the report by severity; must outlive the result.
ReportPictures drawReportPictures(const FitReportRequest& request, const FitReport& report,
                                  std::span<const ComparedFinding* const> rows,
                                  const ProgressCallback& progress);

/// Writes a picture with its caption.
/// @param description  For who cannot see it.
void putFigure(ReportPageWriter& page, const ReportPicture& picture, const std::string& description,
               const std::string& caption);

}  // namespace nearfit
