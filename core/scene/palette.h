#pragma once

#include <array>

#include "core/scene/scene.h"

namespace nearfit {

/// Colours for parts: of even lightness, distinguishable with the common forms of colour blindness, and less
/// saturated than the glyphs drawn over them.
/// Source: P. Tol, Colour schemes, 2021 (the "muted" set, lightened), with steel first for machine parts.
constexpr std::array<Colour, 10> kPartPalette{{
    {0.62F, 0.69F, 0.76F},  // steel
    {0.90F, 0.67F, 0.36F},  // brass
    {0.43F, 0.68F, 0.62F},  // teal
    {0.80F, 0.52F, 0.56F},  // rose
    {0.55F, 0.60F, 0.84F},  // periwinkle
    {0.72F, 0.74F, 0.42F},  // olive
    {0.69F, 0.50F, 0.72F},  // plum
    {0.53F, 0.80F, 0.90F},  // sky
    {0.72F, 0.56F, 0.44F},  // leather
    {0.86F, 0.83F, 0.58F},  // sand
}};

}  // namespace nearfit
