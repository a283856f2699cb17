// SPDX-License-Identifier: GPL-3.0-or-later
/// Hands for MeshLab's window, for tests alone: MeshLab loads this as it loads plugins, and it does what a user would.
/// It chooses a filter, types a number of faces, presses Apply, takes a picture of the screen, and ends MeshLab.
///
/// Takes from the environment: DRIVER_FILTER, the filter's name; DRIVER_FACES, what to type; DRIVER_PICTURE, a PNG file
/// to write. MeshLab ends with status 0 once the picture is there, and 3 if it could not be brought so far.

#include <unistd.h>

#include <cstdio>
#include <functional>

#include <QAction>
#include <QApplication>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScreen>
#include <QTimer>

namespace {

/// Between two things that are done, for MeshLab to draw what came of the first.
constexpr int pause_milliseconds = 1500;

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

}   // namespace

class WindowDriver : public QObject {
    Q_OBJECT
    Q_PLUGIN_METADATA(IID "decimesh.meshlab.WindowDriver")

public:
    WindowDriver() { then(&WindowDriver::choose_filter); }

private:
    void then(void (WindowDriver::*step)()) { QTimer::singleShot(pause_milliseconds, this, step); }

    static void give_up(const char *missing) {
        std::fprintf(stderr, "window driver: there is no %s\n", missing);
        ::_exit(3);
    }

    void choose_filter() {
        // Without a window manager nobody else makes the window as large as the screen.
        for (QWidget *window : QApplication::topLevelWidgets()) {
            if (qobject_cast<QMainWindow *>(window) != nullptr) {
                window->setGeometry(QApplication::primaryScreen()->geometry());
            }
        }
        const QString name = qEnvironmentVariable("DRIVER_FILTER");
        for (QWidget *window : QApplication::topLevelWidgets()) {
            for (QAction *action : window->findChildren<QAction *>()) {
                if (action->text() == name) {
                    return trigger(action);
                }
            }
            for (QWidget *menu : window->findChildren<QWidget *>()) {
                for (QAction *action : menu->actions()) {
                    if (action->text() == name) {
                        return trigger(action);
                    }
                }
            }
        }
        give_up("such filter");
    }

    void trigger(QAction *action) {
        then(&WindowDriver::type_faces);
        action->trigger();
    }

    void type_faces() {
        auto *label = find<QLabel>([](QLabel *found) { return found->text() == "Number of faces"; });
        auto *grid = label == nullptr ? nullptr : qobject_cast<QGridLayout *>(label->parentWidget()->layout());
        if (grid == nullptr) {
            give_up("number of faces");
        }
        int row, column, rows, columns;
        grid->getItemPosition(grid->indexOf(label), &row, &column, &rows, &columns);
        auto *field = qobject_cast<QLineEdit *>(grid->itemAtPosition(row, 1)->widget());
        if (field == nullptr) {
            give_up("field for the number of faces");
        }
        field->setText(qEnvironmentVariable("DRIVER_FACES"));
        then(&WindowDriver::apply);
    }

    void apply() {
        auto *button = find<QPushButton>([](QPushButton *found) { return found->text() == "Apply" && found->isVisible(); });
        if (button == nullptr) {
            give_up("button to apply");
        }
        then(&WindowDriver::take_picture);
        button->click();
    }

    void take_picture() {
        if (QApplication::activeModalWidget() != nullptr) {
            give_up("way past a message that the filter failed");
        }
        const QString done = "simplified to " + qEnvironmentVariable("DRIVER_FACES");
        const auto *log =
            find<QPlainTextEdit>([&done](QPlainTextEdit *found) { return found->toPlainText().contains(done); });
        if (log == nullptr) {
            give_up("line in the log that it was applied");
        }
        if (!QApplication::primaryScreen()->grabWindow(0).save(qEnvironmentVariable("DRIVER_PICTURE"), "PNG")) {
            give_up("picture");
        }
        // Its window would ask whether to save.
        ::_exit(0);
    }
};

#include "window_driver.moc"
