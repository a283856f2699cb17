// SPDX-License-Identifier: GPL-3.0-or-later
/// Hands for MeshLab's window, for tests alone: MeshLab loads this as it loads plugins, and it does what a user would.
///
/// Takes the steps from DRIVER_STEPS in the environment, a line each:
///
///     filter NAME           choose the filter
///     type LABEL = VALUE    fill the field beside the label
///     apply                 press Apply
///     close                 press Close
///     show ROW              press the eye of a layer: it is shown, or hidden
///     expect TEXT           there is no message that something failed, and the log has this text
///     picture FILE          leave the screen as it is in a PNG file
///
/// MeshLab ends with status 0 after the last step, and 3 over one that could not be done.

#include <unistd.h>

#include <cstdio>
#include <functional>

#include <QAction>
#include <QApplication>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QMouseEvent>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScreen>
#include <QStringList>
#include <QTimer>
#include <QTreeWidget>

namespace {

/// Between two steps, for MeshLab to draw what came of the first.
constexpr int pause_milliseconds = 1200;

template <class T>
T *find(const std::function<bool(T *)> &is_wanted) {
    for (QWidget *window : QApplication::topLevelWidgets()) {
        for (T *found : window->findChildren<T *>()) {
            if (is_wanted(found)) {
                return found;
            }
        }
    }
    return nullptr;
}

/// The filter of a menu. Menus that were never open have their actions, and no window owns those of plugins.
QAction *find_filter(const QString &name) {
    QAction *filter = find<QAction>([&name](QAction *found) { return found->text() == name; });
    if (filter == nullptr) {
        find<QWidget>([&](QWidget *menu) {
            for (QAction *action : menu->actions()) {
                filter = action->text() == name ? action : filter;
            }
            return filter != nullptr;
        });
    }
    return filter;
}

QLineEdit *find_field(const QString &label_text) {
    auto *label = find<QLabel>([&label_text](QLabel *found) { return found->text() == label_text; });
    auto *grid = label == nullptr ? nullptr : qobject_cast<QGridLayout *>(label->parentWidget()->layout());
    if (grid == nullptr) {
        return nullptr;
    }
    int row, column, rows, columns;
    grid->getItemPosition(grid->indexOf(label), &row, &column, &rows, &columns);
    return qobject_cast<QLineEdit *>(grid->itemAtPosition(row, 1)->widget());
}

bool choose(const QString &name) {
    QAction *filter = find_filter(name);
    // Not from here: one without parameters would be applied, and not return before that.
    return filter != nullptr && QMetaObject::invokeMethod(filter, "trigger", Qt::QueuedConnection);
}

bool type(const QString &label, const QString &value) {
    QLineEdit *field = find_field(label);
    if (field != nullptr) {
        field->setText(value);
    }
    return field != nullptr;
}

bool press(const QString &name) {
    auto *button =
        find<QPushButton>([&name](QPushButton *found) { return found->text() == name && found->isVisible(); });
    return button != nullptr && QMetaObject::invokeMethod(button, "click", Qt::QueuedConnection);
}

bool press_eye(int row) {
    const auto *layers = find<QTreeWidget>([](QTreeWidget *found) { return found->objectName() == "meshTreeWidget"; });
    QTreeWidgetItem *layer = layers == nullptr ? nullptr : layers->topLevelItem(row);
    if (layer == nullptr) {
        return false;
    }
    const QPoint eye = layers->visualItemRect(layer).center();
    for (const QEvent::Type event : {QEvent::MouseButtonPress, QEvent::MouseButtonRelease}) {
        const QPoint place(layers->columnViewportPosition(0) + layers->columnWidth(0) / 2, eye.y());
        QApplication::postEvent(layers->viewport(),
                                new QMouseEvent(event, place, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier));
    }
    return true;
}

bool has_logged(const QString &text) {
    return QApplication::activeModalWidget() == nullptr &&
           find<QPlainTextEdit>([&text](QPlainTextEdit *log) { return log->toPlainText().contains(text); }) != nullptr;
}

bool do_step(const QString &name, const QString &rest) {
    if (name == "filter") {
        return choose(rest);
    }
    if (name == "type") {
        return type(rest.section(" = ", 0, 0), rest.section(" = ", 1));
    }
    if (name == "apply") {
        return press("Apply");
    }
    if (name == "close") {
        return press("Close");
    }
    if (name == "show") {
        return press_eye(rest.toInt());
    }
    if (name == "expect") {
        return has_logged(rest);
    }
    return name == "picture" && QApplication::primaryScreen()->grabWindow(0).save(rest, "PNG");
}

}   // namespace

class WindowDriver : public QObject {
    Q_OBJECT
    Q_PLUGIN_METADATA(IID "decimesh.meshlab.WindowDriver")

public:
    WindowDriver() : steps_(qEnvironmentVariable("DRIVER_STEPS").split('\n')) {
        connect(&timer_, &QTimer::timeout, this, &WindowDriver::go_on);
        timer_.start(pause_milliseconds);
    }

private:
    void go_on() {
        // Without a window manager nobody else makes the window as large as the screen.
        for (QWidget *window : QApplication::topLevelWidgets()) {
            if (qobject_cast<QMainWindow *>(window) != nullptr) {
                window->setGeometry(QApplication::primaryScreen()->geometry());
            }
        }
        // Its window would ask whether to save.
        if (steps_.isEmpty()) {
            ::_exit(0);
        }
        const QString step = steps_.takeFirst();
        if (!do_step(step.section(' ', 0, 0), step.section(' ', 1))) {
            std::fprintf(stderr, "window driver: could not do \"%s\"\n", step.toUtf8().constData());
            ::_exit(3);
        }
    }

    QStringList steps_;
    QTimer timer_;
};

#include "window_driver.moc"
