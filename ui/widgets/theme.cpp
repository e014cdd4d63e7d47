#include "ui/widgets/theme.h"

#include <QApplication>
#include <QEvent>
#include <QFile>
#include <QIconEngine>
#include <QImage>
#include <QPainter>
#include <QPalette>
#include <QPixmapCache>
#include <QSettings>
#include <QSvgRenderer>
#include <QWidget>
#include <algorithm>
#include <utility>

#include "ui/widgets/window_style.h"

// Q_INIT_RESOURCE declares a function, so it must stand outside any namespace.
static void initResources() {
  Q_INIT_RESOURCE(nearfit);
}

namespace nearfit::ui {
namespace {

const QString kSchemeKey = QStringLiteral("window/theme");

constexpr const char* kStyleSheet = R"(
QMainWindow { background: #eef1f4; }
QMainWindow::separator { background: #d5dbe1; width: 1px; height: 1px; }
QMainWindow::separator:hover { background: #1f73d0; }
QMenuBar { background: #f7f9fa; border-bottom: 1px solid #d5dbe1; }
QMenuBar::item { padding: 4px 9px; background: transparent; }
QMenuBar::item:selected { background: #dcebfb; border-radius: 3px; }
QToolBar { background: #f7f9fa; border: none; border-bottom: 1px solid #d5dbe1; padding: 3px 6px; spacing: 2px; }
QToolBar::separator { background: #d5dbe1; width: 1px; margin: 5px 6px; }
QToolBar QToolButton { border: 1px solid transparent; border-radius: 4px; padding: 4px; }
QToolBar QToolButton:hover { background: #e6eef7; border-color: #c9d9ea; }
QToolBar QToolButton:pressed, QToolBar QToolButton:checked { background: #d3e5f8; border-color: #9fc4ec; }
QDockWidget { font-weight: bold; color: #3b4754; }
QDockWidget::title { background: #e4e9ee; padding: 6px 10px; }
QDockWidget > QWidget { background: #f7f9fa; }
QStatusBar { background: #f7f9fa; border-top: 1px solid #d5dbe1; }
QStatusBar::item { border: none; }
QTreeView { border: none; background: #ffffff; outline: none; }
QTreeView::item { min-height: 28px; border: none; padding-left: 4px; }
QTreeView::item:hover { background: #f0f5fa; }
QTreeView::item:selected { background: #d3e5f8; color: #16202a; }
QDialogButtonBox { dialogbuttonbox-buttons-have-icons: 0; }
QToolTip { background: #2c3640; color: white; border: none; padding: 4px; }
)";

/// Colours of the light theme in style sheets and icons, each with its dark counterpart. Text and strokes
/// keep at least their contrast. Colours by name, such as white, are the same in both themes.
constexpr std::pair<const char*, const char*> kDarkColours[] = {
    {"#eef1f4", "#14181c"},
    {"#d5dbe1", "#39434d"},
    {"#1f73d0", "#62adf5"},
    {"#f7f9fa", "#20262c"},
    {"#dcebfb", "#2b4763"},
    {"#e6eef7", "#2e3842"},
    {"#c9d9ea", "#465667"},
    {"#d3e5f8", "#2c4a68"},
    {"#9fc4ec", "#4f7fae"},
    {"#3b4754", "#c3ccd5"},
    {"#e4e9ee", "#2a323a"},
    {"#ffffff", "#1a1f24"},
    {"#f0f5fa", "#283038"},
    {"#16202a", "#f0f4f8"},
    {"#2c3640", "#39434d"},
    {"#1c252e", "#e8edf2"},
    {"#5d6874", "#9ba7b3"},
    {"#b34a00", "#ffab66"},
    {"#d82c20", "#ff7a6e"},
    {"#c8372d", "#ff7a6e"},
    {"#e03b2f", "#ff7a6e"},
    {"#fdf0e3", "#3b2c1c"},
    {"#e8c39b", "#7a5a34"},
    {"#c9d2db", "#414c57"},
    {"#0b8484", "#45c4c4"},
    {"#7b2fbe", "#bf8cf0"},
    {"#b0155e", "#f278ad"},
    {"#b05c10", "#e09a52"},
    {"#e2711d", "#ff9a52"},
    {"#5a7a00", "#b6d957"},
    {"#445c00", "#b6d957"},
    {"#6e7e8f", "#98a3ae"},
    {"rgba(255, 255, 255, 235)", "rgba(32, 38, 44, 240)"},
    {"fill=\"#fff\"", "fill=\"#2e3740\""}};

/// True if the desktop's own palette is dark; ask before this program first sets a palette.
bool isDesktopDark() {
  static const bool isDark = QApplication::palette().color(QPalette::Window).lightness() < 128;
  return isDark;
}

bool& darkness() {
  static bool isDark = false;
  return isDark;
}

QPalette paletteOf(bool isDark) {
  const auto colour = [isDark](const char* light) {
    return QColor(isDark ? inDarkColours(QString::fromLatin1(light)) : QString::fromLatin1(light));
  };
  QPalette palette;
  palette.setColor(QPalette::Window, colour("#f7f9fa"));
  palette.setColor(QPalette::Base, colour("#ffffff"));
  palette.setColor(QPalette::AlternateBase, colour("#f0f5fa"));
  palette.setColor(QPalette::Button, isDark ? QColor(0x2e, 0x37, 0x40) : QColor(0xf7, 0xf9, 0xfa));
  palette.setColor(QPalette::ToolTipBase, QColor(0x2c, 0x36, 0x40));
  palette.setColor(QPalette::ToolTipText, Qt::white);
  palette.setColor(QPalette::Highlight, colours::kAccent);
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Link, colour("#1f73d0"));
  palette.setColor(QPalette::BrightText, Qt::white);
  if (isDark) {
    // Fusion draws frames and grooves from these.
    palette.setColor(QPalette::Light, QColor(0x46, 0x51, 0x5c));
    palette.setColor(QPalette::Midlight, QColor(0x3a, 0x44, 0x4e));
    palette.setColor(QPalette::Mid, QColor(0x29, 0x31, 0x38));
    palette.setColor(QPalette::Dark, QColor(0x14, 0x18, 0x1c));
    palette.setColor(QPalette::Shadow, Qt::black);
  }
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    palette.setColor(role, colour("#1c252e"));
    palette.setColor(QPalette::Disabled, role, isDark ? QColor(0x8a, 0x95, 0xa0) : QColor(0x9a, 0xa4, 0xae));
  }
  palette.setColor(QPalette::PlaceholderText, colour("#5d6874"));
  return palette;
}

/// Translates the style sheets of widgets, written in the light theme's colours, to the dark theme and back.
class SheetTranslator : public QObject {
 public:
  using QObject::QObject;

  void translate(QWidget* widget) {
    const QString sheet = widget->styleSheet();
    if (sheet.isEmpty()) return;
    const QVariant original = widget->property(kOriginal), made = widget->property(kMade);
    // A sheet that the widget has set since is the new original.
    const bool isOwn = !made.isValid() || made.toString() != sheet;
    const QString light = isOwn ? sheet : original.toString();
    const QString wanted = darkness() ? inDarkColours(light) : light;
    if (wanted == sheet) return;
    widget->setProperty(kOriginal, light);
    widget->setProperty(kMade, wanted);
    widget->setStyleSheet(wanted);
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    // A sheet set before the widget is shown only causes a Polish event.
    const bool isStyled = event->type() == QEvent::StyleChange || event->type() == QEvent::Polish;
    if (isStyled && darkness() && watched->isWidgetType()) translate(static_cast<QWidget*>(watched));
    return false;
  }

 private:
  static constexpr const char* kOriginal = "nearfitLightSheet";
  static constexpr const char* kMade = "nearfitMadeSheet";
};

SheetTranslator& translator() {
  static auto* instance = [] {
    auto* made = new SheetTranslator(qApp);
    qApp->installEventFilter(made);
    return made;
  }();
  return *instance;
}

void apply(bool isDark) {
  darkness() = isDark;
  QApplication::setPalette(paletteOf(isDark));
  const QString sheet = QString::fromLatin1(kStyleSheet);
  // Replacing a sheet makes Qt 5.15 visit all widgets it remembers, even deleted ones; clearing the sheet
  // first makes it forget them.
  qApp->setStyleSheet({});
  qApp->setStyleSheet(isDark ? inDarkColours(sheet) : sheet);
  // Creates the translator at the start too, when there are no widgets yet.
  SheetTranslator& sheets = translator();
  const QWidgetList widgets = QApplication::allWidgets();
  for (QWidget* widget : widgets)
    sheets.translate(widget);
}

bool isWantedDark(ColourScheme scheme) {
  return scheme == ColourScheme::System ? isDesktopDark() : scheme == ColourScheme::Dark;
}

/// Paints an icon of resources/icons in the colours of the theme at that moment, light or dark.
class ThemedIcon : public QIconEngine {
 public:
  /// @param file  The SVG's resource path.
  explicit ThemedIcon(const QString& file) : file_(file) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override;
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override;
  QIconEngine* clone() const override { return new ThemedIcon(file_); }

 private:
  QString file_;
};

QPixmap draw(const QString& file, const QSize& size, bool isDark) {
  QFile svg(file);
  if (!svg.open(QIODevice::ReadOnly)) return {};
  QString text = QString::fromUtf8(svg.readAll());
  if (isDark) text = inDarkColours(text);
  QSvgRenderer renderer(text.toUtf8());
  QPixmap pixmap(size);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  renderer.render(&painter);
  return pixmap;
}

/// Returns the picture of what cannot be used now: grey and faint on any ground. Qt's own is meant for light
/// grounds; on a dark one it stands out.
QPixmap faded(const QPixmap& pixmap) {
  constexpr double kOpacity = 0.35;
  QImage image = pixmap.toImage().convertToFormat(QImage::Format_ARGB32);
  for (int y = 0; y < image.height(); ++y) {
    auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
    for (int x = 0; x < image.width(); ++x) {
      const int grey = qGray(line[x]);
      line[x] = qRgba(grey, grey, grey, qRound(kOpacity * qAlpha(line[x])));
    }
  }
  return QPixmap::fromImage(image);
}

void ThemedIcon::paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) {
  const qreal ratio = painter->device() != nullptr ? painter->device()->devicePixelRatioF() : 1.0;
  QPixmap shown = pixmap(rect.size() * ratio, mode, state);
  shown.setDevicePixelRatio(ratio);
  painter->drawPixmap(rect, shown);
}

QPixmap ThemedIcon::pixmap(const QSize& size, QIcon::Mode mode, QIcon::State) {
  const bool isDark = isThemeDark();
  const QString key = QStringLiteral("nearfit:%1:%2x%3:%4:%5")
                          .arg(file_)
                          .arg(size.width())
                          .arg(size.height())
                          .arg(static_cast<int>(mode))
                          .arg(isDark);
  QPixmap pixmap;
  if (QPixmapCache::find(key, &pixmap)) return pixmap;
  pixmap = draw(file_, size, isDark);
  if (mode == QIcon::Disabled) pixmap = faded(pixmap);
  QPixmapCache::insert(key, pixmap);
  return pixmap;
}

}  // namespace

QColor axisColour(int axis) {
  constexpr QRgb kColours[] = {0xffd93a3a, 0xff2e9e4f, 0xff2f6fe0};
  return axis < 0 ? QColor(0x4a, 0x55, 0x61) : QColor(kColours[axis]);
}

void loadResources() {
  initResources();
}

void applyTheme(QApplication&) {
  loadResources();
  isDesktopDark();
  QApplication::setStyle(new WindowStyle);
  apply(isWantedDark(colourScheme()));
  QApplication::setWindowIcon(icon(QStringLiteral("nearfit")));
}

ColourScheme colourScheme() {
  const QString kept = QSettings().value(kSchemeKey).toString();
  if (kept == QLatin1String("dark")) return ColourScheme::Dark;
  return kept == QLatin1String("light") ? ColourScheme::Light : ColourScheme::System;
}

void setColourScheme(ColourScheme scheme) {
  const char* names[] = {"system", "light", "dark"};
  QSettings().setValue(kSchemeKey, QLatin1String(names[static_cast<int>(scheme)]));
  apply(isWantedDark(scheme));
}

bool isThemeDark() {
  return darkness();
}

QString inDarkColours(const QString& light) {
  // One pass over the text: the result of one pair must not match another.
  QString dark;
  dark.reserve(light.size());
  for (int at = 0; at < light.size();) {
    int length = 0;
    for (const auto& [from, to] : kDarkColours) {
      const QLatin1String sought(from);
      if (QStringView(light).mid(at).startsWith(sought, Qt::CaseInsensitive)) {
        dark += QLatin1String(to);
        length = sought.size();
        break;
      }
    }
    if (length == 0) dark += light[at];
    at += std::max(length, 1);
  }
  return dark;
}

QColor themed(const QColor& light) {
  return isThemeDark() ? QColor(inDarkColours(light.name())) : light;
}

ViewGround viewGround() {
  if (isThemeDark()) return {QColor::fromRgbF(0.27, 0.31, 0.36), QColor::fromRgbF(0.13, 0.15, 0.18)};
  return {QColor::fromRgbF(0.72, 0.78, 0.85), QColor::fromRgbF(0.955, 0.968, 0.98)};
}

QColor outlineColour(const QColor& light) {
  // Percent of Qt: by what the lightness is divided.
  constexpr int kDarker = 150;
  return isThemeDark() ? themed(light) : light.darker(kDarker);
}

QIcon icon(const QString& name) {
  // The program's icon is the same in both themes.
  const QString file = QStringLiteral(":/icons/%1.svg").arg(name);
  return name == QLatin1String("nearfit") ? QIcon(file) : QIcon(new ThemedIcon(file));
}

}  // namespace nearfit::ui
