#pragma once

#include <map>
#include <string>

namespace nearfit::test {

/// Contents of a ZIP file by name, read by its central directory. Fails the test, and may return less, where the file
/// contradicts itself: a checksum, a size or a name that differs, bytes behind the end.
std::map<std::string, std::string> zipEntries(const std::string& bytes);

}  // namespace nearfit::test
