#pragma once

#include <string>

#include "app/import/import_job.h"

namespace nearfit::importer {

/// Reads a job's file by the reader of its format. Throws FileError, std::bad_alloc.
CadDocument readDocumentOf(const ImportJob& job);

/// Writes what a document holds to stderr, for people.
void printSummary(const CadDocument& document);

std::string occVersion();

}  // namespace nearfit::importer
