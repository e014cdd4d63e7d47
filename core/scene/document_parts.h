#pragma once

#include "core/math/aabb.h"
#include "core/scene/document_load.h"
#include "core/scene/new_nodes.h"

namespace nearfit {

/// What a document becomes in a scene: a part for each instance of a shape, where the document places it, and a group
/// for each assembly. Several items at the top level get a group with the file's name. Assemblies without parts are
/// left out. Parts and groups without a name get the file's name and a number; the only part of a document gets the
/// file's name if its own is a number or a word such as "Part" or "Document". An instance without a colour has that of
/// the nearest assembly around it. Groups beyond kMaxGroupDepth, and beyond what `scene` can hold, are left out: their
/// parts go to the nearest group that is there, with both names.
/// Throws FileError if the document places more parts than a scene file can hold, or one farther than kMaxPosition.
NewNodes partsOfDocument(const LoadedDocument& document, const Scene& scene);

/// Box around all instances, where the document places them [m]; empty if there are none.
Aabb boundsOfDocument(const LoadedDocument& document);

}  // namespace nearfit
