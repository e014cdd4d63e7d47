#pragma once

#include <span>

#include "core/report/html/fit_report.h"
#include "core/report/html/report_page_writer.h"
#include "core/report/html/report_pictures.h"

/// Contents of the sections of a report's page, without their headings. `rows` are its findings by severity.
namespace nearfit {

void putPairs(ReportPageWriter& page, const SceneCheck& check, std::span<const ComparedFinding* const> rows);
void putFindings(ReportPageWriter& page, const Scene& scene, const ReportPictures& pictures,
                 std::span<const ComparedFinding* const> rows);
void putPath(ReportPageWriter& page, const FitReportRequest& request, const PathFindings& path);
void putUnchecked(ReportPageWriter& page, const FitReportRequest& request, const FitReport& report);
void putParts(ReportPageWriter& page, const Scene& scene);
void putSettings(ReportPageWriter& page, const FitReportRequest& request, const FitReport& report);
void putInputs(ReportPageWriter& page, const FitReportRequest& request);
void putVersions(ReportPageWriter& page, const ReportOrigin& origin);

}  // namespace nearfit
