#pragma once

#include <vector>

#include "tests/bench/window/figure.h"

/// Each makes the figures of one question; those of two ways are measured in turns.
namespace nearfit::bench {

/// From the start of the program to a window that has drawn and answers.
std::vector<Figure> measureStarts(const WindowOptions& options);
/// What a start begins: the same as the application, until it is usable; says so on the standard output.
int startAndLeave(int argc, char** argv);

/// A scene turned by the mouse while the servo runs, and the servo's lateness with and without that.
std::vector<Figure> measureFrames(const WindowOptions& options);
/// The servo's lateness while a scene is checked beside it, and without that.
std::vector<Figure> measureBesideCheck(const WindowOptions& options);
/// The same while reports are written.
std::vector<Figure> measureBesideReport(const WindowOptions& options);
/// What the processor does while nobody does anything.
std::vector<Figure> measureIdle(const WindowOptions& options);
/// What minima add to a picture.
std::vector<Figure> measureGlyphs(const WindowOptions& options);
std::vector<Figure> measurePicks(const WindowOptions& options);
/// How long events wait while a large mesh is opened.
std::vector<Figure> measureOpening(const WindowOptions& options);
/// How long events wait while CAD documents are opened, from their files and from the cache, and how long it is from
/// the drop until they can be felt. Documents are those of the shared models, and an assembly that nearfit-bench-occ
/// makes; without both there are no figures.
std::vector<Figure> measureDocuments(const WindowOptions& options);
/// How long the window takes to be free again once the opening of a large mesh is cancelled.
std::vector<Figure> measureCancels(const WindowOptions& options);
/// Many parts with many triangles.
std::vector<Figure> measureLarge(const WindowOptions& options);

}  // namespace nearfit::bench
