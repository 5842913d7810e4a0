// SPDX-License-Identifier: MIT
#include "viewer/ui.h"

#include <filesystem>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace talus::viewer {

namespace {

constexpr float k_letter_height = 15.0f; // pixels of a usual screen
// Dear ImGui's own letters are a bitmap of 13 pixels; these are there on most systems, and scale.
constexpr const char* k_font_files[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
};
constexpr ImWchar k_letters[] = {0x20, 0xff, 0x370, 0x3ff, 0x2010, 0x205f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};

void set_style(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.FrameRounding = style.GrabRounding = 3.0f;
    style.WindowBorderSize = 0.0f;
    style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.10f, 0.12f, 0.90f};
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

} // namespace

Ui::Ui(Window& shown_in) : window(shown_in) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // panels have their place; no file is left behind
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Ui::~Ui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Ui::fit_letters(float scale) {
    if (scale == fitted_scale) return;
    fitted_scale = scale;
    set_style(scale);
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    io.FontGlobalScale = 1.0f;
    ImFont* font = nullptr;
    for (const char* file : k_font_files) {
        std::error_code ignored;
        if (font == nullptr && std::filesystem::exists(file, ignored))
            font = io.Fonts->AddFontFromFileTTF(file, k_letter_height * scale, nullptr, k_letters);
    }
    if (font == nullptr) {
        io.Fonts->AddFontDefault();
        io.FontGlobalScale = scale;
    }
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Ui::begin() {
    fit_letters(window.content_scale());
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    hold_keys(true);
    ImGui::NewFrame();
    hold_keys(false);
    pressed.clear();
}

void Ui::hold_keys([[maybe_unused]] bool for_frame) {
#if IMGUI_VERSION_NUM < 18700 // from then on it has a queue of keys itself
    for (const int key : pressed)
        if (key >= 0) ImGui::GetIO().KeysDown[key] = for_frame || window.is_key_down(key);
#endif
}

void Ui::end() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Ui::wants_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wants_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

} // namespace talus::viewer
