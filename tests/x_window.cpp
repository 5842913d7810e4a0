// SPDX-License-Identifier: MIT
#include "x_window.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>

namespace talus::tests {

namespace {

using Clock = std::chrono::steady_clock;

/// Starts a program that takes its orders from nobody, and says where its messages go.
pid_t start(const std::vector<std::string>& command, const std::filesystem::path& folder, const std::string& display,
            const std::filesystem::path& messages) {
    std::vector<char*> words;
    for (const std::string& word : command)
        words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    const int out = open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    if (!display.empty()) setenv("DISPLAY", display.c_str(), 1);
    if (chdir(folder.c_str()) == 0) execvp(words[0], words.data());
    _exit(127);
}

void end(pid_t process) {
    if (process <= 0) return;
    kill(process, SIGTERM);
    waitpid(process, nullptr, 0);
}

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool wait_until(double seconds, const std::function<bool()>& condition) {
    const auto last = Clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (Clock::now() > last) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

} // namespace

struct XWindow::Impl {
    ~Impl() {
        end(program);
        if (display != nullptr) XCloseDisplay(display);
        end(server);
    }

    void start_screen(const std::filesystem::path& folder, int dots_per_inch);
    bool find_window();
    Atom atom(const char* name) const { return XInternAtom(display, name, False); }
    void send_to_window(const char* type, std::initializer_list<long> values) const;

    pid_t server = 0, program = 0;
    std::string display_name;
    Display* display = nullptr;
    Window window = 0;
};

void XWindow::Impl::start_screen(const std::filesystem::path& folder, int dots_per_inch) {
    // The server takes a free number and writes it to a file descriptor of ours.
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    server = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1280x900x24", "-nolisten", "tcp"},
                   folder, "", folder / "Xvfb.log");
    close(ends[1]);
    std::string number(16, '\0');
    const ssize_t count = read(ends[0], number.data(), number.size());
    close(ends[0]);
    if (count <= 0) throw std::runtime_error("Xvfb does not start: " + text_of(folder / "Xvfb.log"));
    display_name = ':';
    display_name.append(number, 0, number.find('\n'));
    display = XOpenDisplay(display_name.c_str());
    if (display == nullptr) throw std::runtime_error("the screen " + display_name + " cannot be opened");
    // As desktops tell programs how large letters should be.
    const std::string resources = "Xft.dpi:\t" + std::to_string(dots_per_inch) + "\n";
    XChangeProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resources.data()), static_cast<int>(resources.size()));
    XSync(display, False);
}

bool XWindow::Impl::find_window() {
    Window root, parent, *children = nullptr;
    unsigned count = 0;
    XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
    for (unsigned i = 0; i < count; ++i) {
        XWindowAttributes attributes;
        char* name = nullptr;
        if (XGetWindowAttributes(display, children[i], &attributes) != 0 && attributes.map_state == IsViewable &&
            XFetchName(display, children[i], &name) != 0 && name != nullptr) {
            // The title tells more once the first picture is there.
            if (std::strncmp(name, "Talus: ", 7) == 0) window = children[i];
            XFree(name);
        }
    }
    if (children != nullptr) XFree(children);
    return window != 0;
}

XWindow::XWindow(const std::vector<std::string>& command, const std::filesystem::path& folder, int dots_per_inch)
    : impl_(std::make_unique<Impl>()) {
    impl_->start_screen(folder.parent_path(), dots_per_inch);
    const std::filesystem::path messages = folder.parent_path() / "program.log";
    impl_->program = start(command, folder, impl_->display_name, messages);
    int status = 0;
    bool ended = false;
    const bool opened = wait_until(60.0, [&] {
        ended = waitpid(impl_->program, &status, WNOHANG) == impl_->program;
        return ended || impl_->find_window();
    });
    if (ended) impl_->program = 0;
    if (!opened || ended) throw std::runtime_error("no window appears; the program said: " + text_of(messages));
    // There is no window manager here that would do it.
    XSetInputFocus(impl_->display, impl_->window, RevertToParent, CurrentTime);
    XSync(impl_->display, False);
}

XWindow::~XWindow() = default;

bool XWindow::is_possible() {
    return std::system("command -v Xvfb >/dev/null") == 0;
}

std::string XWindow::title() const {
    char* name = nullptr;
    if (XFetchName(impl_->display, impl_->window, &name) == 0 || name == nullptr) return {};
    std::string text(name);
    XFree(name);
    return text;
}

bool XWindow::wait_for_title(const std::function<bool(const std::string&)>& wanted, double seconds) const {
    return wait_until(seconds, [&] { return wanted(title()); });
}

int XWindow::wait_for_end(double seconds) {
    int status = -1;
    const bool ended = wait_until(seconds, [&] { return waitpid(impl_->program, &status, WNOHANG) == impl_->program; });
    if (!ended) return -1;
    impl_->program = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void XWindow::hold(const std::string& key, bool down) const {
    const KeyCode code = XKeysymToKeycode(impl_->display, XStringToKeysym(key.c_str()));
    if (code == 0) throw std::runtime_error("no key " + key);
    XTestFakeKeyEvent(impl_->display, code, down, CurrentTime);
    XSync(impl_->display, False);
}

void XWindow::press(const std::string& keys) const {
    const std::size_t plus = keys.find('+');
    if (plus != std::string::npos) {
        hold(keys.substr(0, plus), true);
        press(keys.substr(plus + 1));
        hold(keys.substr(0, plus), false);
        return;
    }
    hold(keys, true); // and up again before the program has drawn a frame
    hold(keys, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(5)); // GLFW takes two presses within a millisecond for one
}

void XWindow::move_mouse(int x, int y) const {
    XTestFakeMotionEvent(impl_->display, -1, x, y, CurrentTime);
    XSync(impl_->display, False);
}

void XWindow::hold_button(int button, bool down) const {
    XTestFakeButtonEvent(impl_->display, static_cast<unsigned>(button), down, CurrentTime);
    XSync(impl_->display, False);
}

void XWindow::click(int x, int y) const {
    // Panels look at the mouse once a frame: it must not be elsewhere when its button is pressed or let go.
    const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(300)); };
    move_mouse(x, y);
    pause();
    hold_button(1, true);
    pause();
    hold_button(1, false);
    pause();
}

void XWindow::turn_wheel(int notches) const {
    for (int i = 0; i < std::abs(notches); ++i)
        for (const bool down : {true, false})
            hold_button(notches > 0 ? 4 : 5, down);
}

void XWindow::Impl::send_to_window(const char* type, std::initializer_list<long> values) const {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    std::copy(values.begin(), values.end(), event.xclient.data.l);
    XSendEvent(display, window, False, NoEventMask, &event);
    XSync(display, False);
}

void XWindow::drop_file(const std::filesystem::path& path) const {
    Display* const display = impl_->display;
    const Window source = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    const Atom selection = impl_->atom("XdndSelection"), uris = impl_->atom("text/uri-list");
    const std::string content = std::string("file://").append(path.string()).append("\r\n");
    XSetSelectionOwner(display, selection, source, CurrentTime);
    const long own = static_cast<long>(source);
    impl_->send_to_window("XdndEnter", {own, 5l << 24, static_cast<long>(uris), 0, 0});
    impl_->send_to_window("XdndPosition",
                          {own, 0, (400l << 16) | 300, CurrentTime, static_cast<long>(impl_->atom("XdndActionCopy"))});
    impl_->send_to_window("XdndDrop", {own, 0, CurrentTime, 0, 0});
    // The window now asks for the content.
    const bool asked = wait_until(10.0, [&] {
        XEvent event;
        if (!XCheckTypedWindowEvent(display, source, SelectionRequest, &event)) return false;
        const XSelectionRequestEvent& request = event.xselectionrequest;
        XChangeProperty(display, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(content.data()), static_cast<int>(content.size()));
        XEvent answer{};
        answer.xselection.type = SelectionNotify;
        answer.xselection.requestor = request.requestor;
        answer.xselection.selection = request.selection;
        answer.xselection.target = request.target;
        answer.xselection.property = request.property;
        answer.xselection.time = request.time;
        XSendEvent(display, request.requestor, False, NoEventMask, &answer);
        XSync(display, False);
        return true;
    });
    if (!asked) throw std::runtime_error("the window does not ask for what is dropped on it");
}

render::Picture XWindow::look() const {
    XWindowAttributes attributes;
    XGetWindowAttributes(impl_->display, impl_->window, &attributes);
    render::Picture picture{
        static_cast<std::uint32_t>(attributes.width), static_cast<std::uint32_t>(attributes.height), {}};
    XImage* image = XGetImage(impl_->display, impl_->window, 0, 0, picture.width, picture.height, AllPlanes, ZPixmap);
    if (image == nullptr) throw std::runtime_error("the window cannot be looked at");
    for (int y = 0; y < attributes.height; ++y) {
        for (int x = 0; x < attributes.width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const int shift : {16, 8, 0})
                picture.rgb.push_back(static_cast<std::uint8_t>(pixel >> shift & 0xffu));
        }
    }
    XDestroyImage(image);
    return picture;
}

} // namespace talus::tests
