#pragma once

#include <QColor>
#include <QIcon>
#include <QString>

class QApplication;

namespace nearfit::ui {

/// Colours with a meaning, the same in widgets and in the 3-D view.
namespace colours {
inline const QColor kAccent(0x1f, 0x73, 0xd0);
inline const QColor kForce(0xd8, 0x2c, 0x20);
inline const QColor kTorque(0x7b, 0x2f, 0xbe);
inline const QColor kContact(0xb0, 0x15, 0x5e);
inline const QColor kHand(0x0b, 0x84, 0x84);
inline const QColor kOverlap(0xe0, 0x3b, 0x2f);
inline const QColor kMoving(0xe2, 0x71, 0x1d);
inline const QColor kClearance(0x0b, 0x84, 0x84);
inline const QColor kAtLeast(0xb0, 0x5c, 0x10);  ///< Lower bounds on a clearance.
inline const QColor kJoint(0x5a, 0x7a, 0x00);
inline const QColor kJointText(0x44, 0x5c, 0x00);  ///< Of joints; kJoint is too light for letters.
inline const QColor kMutedText(0x5d, 0x68, 0x74);
inline const QColor kWarning(0xb3, 0x4a, 0x00);
inline const QColor kOutline(0x6e, 0x7e, 0x8f);  ///< Edges of parts drawn as outlines; see outlineColour().
}  // namespace colours

/// Returns the colour of axis 0, 1 or 2; for -1 that of the direction of view.
QColor axisColour(int axis);

/// Registers this library's compiled-in icons; may be called again.
void loadResources();
/// Light, dark, or as the desktop is.
enum class ColourScheme { System, Light, Dark };

/// Returns the user's choice, kept between runs.
ColourScheme colourScheme();
/// Changes everything shown at once and stores the choice. Widgets write their style sheets in the light
/// theme's colours; in the dark theme those are translated. The view follows QEvent::PaletteChange.
void setColourScheme(ColourScheme scheme);
/// True if the dark theme is applied now.
bool isThemeDark();
/// Returns a style sheet or SVG with the light theme's colours replaced by those of the dark theme.
QString inDarkColours(const QString& light);

/// Returns a colour of the light theme as it is in the present theme; for painting and model data, which
/// style sheets do not reach.
QColor themed(const QColor& light);

/// Colours of the background of the 3-D view, which passes from one to the other.
struct ViewGround {
  QColor lower, upper;
};
/// Returns the background in the present theme.
ViewGround viewGround();
/// Returns a colour with a meaning as thin lines before that background have it: of a contrast of 3 or more by WCAG 2.1.
/// In the dark theme kOutline is no lighter than that needs: pictures may have a white ground.
/// @param light  kOutline, kAccent, kMoving or kOverlap.
QColor outlineColour(const QColor& light);

/// Sets style, palette, window icon and style sheet of the application. Call once, before there are widgets.
void applyTheme(QApplication& application);
/// Returns an icon of resources/icons by its file name without extension; follows the theme.
QIcon icon(const QString& name);

}  // namespace nearfit::ui
