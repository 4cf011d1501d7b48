// SPDX-License-Identifier: MIT
#include "window/ui.h"

#include <epoxy/gl.h>

#include <filesystem>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "quincunx_gl/capabilities.h"
#include "tools/image/text_painter.h"

namespace quincunx::scenes {
namespace {

constexpr float kFontPixels = 14;

// Dear ImGui as distributions build it asks for state that desktop OpenGL alone has. OpenGL ES refuses that and changes
// nothing, so for the life of the guard the refusals are neither logged nor left behind.
class RefusalsOfEs {
 public:
  RefusalsOfEs() {
    if (is_es_) glDisable(GL_DEBUG_OUTPUT);
  }
  ~RefusalsOfEs() {
    if (!is_es_) return;
    while (glGetError() != GL_NO_ERROR) {
    }
    glEnable(GL_DEBUG_OUTPUT);
  }
  RefusalsOfEs(const RefusalsOfEs&) = delete;
  RefusalsOfEs& operator=(const RefusalsOfEs&) = delete;

 private:
  bool is_es_ = gl::capabilities().api == gl::Api::kEs3;
};

void load_font() {
  // What the texts of the interface have beyond Latin: multiplication sign, arrows, dots, ellipsis.
  static const ImWchar kGlyphs[] = {0x0020, 0x00ff, 0x2010, 0x2027, 0x2190, 0x2193, 0x2260, 0x2265, 0};
  const char* path = tools::font_path(tools::Face::kSans);
  if (std::filesystem::exists(path)) {
    ImGui::GetIO().Fonts->AddFontFromFileTTF(path, kFontPixels, nullptr, kGlyphs);
  } else {
    ImGui::GetIO().Fonts->AddFontDefault();
  }
}

void set_looks() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 8;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.PopupRounding = 6;
  style.ScrollbarRounding = 6;
  style.ScrollbarSize = 10;
  style.WindowBorderSize = 0;
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 2};
  style.ItemSpacing = {8, 4};
  const ImVec4 accent(.91f, .64f, .24f, 1);
  const ImVec4 dim(.91f, .64f, .24f, .35f);
  const ImVec4 half(.91f, .64f, .24f, .6f);
  ImVec4* colours = style.Colors;
  colours[ImGuiCol_WindowBg] = {.07f, .075f, .09f, .86f};
  colours[ImGuiCol_PopupBg] = {.09f, .095f, .11f, .97f};
  colours[ImGuiCol_Text] = {.92f, .92f, .93f, 1};
  colours[ImGuiCol_TextDisabled] = {.60f, .61f, .64f, 1};
  colours[ImGuiCol_FrameBg] = {1, 1, 1, .09f};
  colours[ImGuiCol_FrameBgHovered] = {1, 1, 1, .15f};
  colours[ImGuiCol_FrameBgActive] = {1, 1, 1, .20f};
  colours[ImGuiCol_Button] = {1, 1, 1, .12f};
  colours[ImGuiCol_ButtonHovered] = dim;
  colours[ImGuiCol_ButtonActive] = half;
  colours[ImGuiCol_Header] = dim;
  colours[ImGuiCol_HeaderHovered] = half;
  colours[ImGuiCol_HeaderActive] = half;
  colours[ImGuiCol_CheckMark] = accent;
  colours[ImGuiCol_SliderGrab] = accent;
  colours[ImGuiCol_SliderGrabActive] = accent;
  colours[ImGuiCol_Separator] = {1, 1, 1, .12f};
}

}  // namespace

Ui::Ui(GLFWwindow* window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no file is left behind
  load_font();
  set_looks();
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  const RefusalsOfEs guard;
  ImGui_ImplOpenGL3_Init(gl::capabilities().api == gl::Api::kGl45 ? "#version 450 core" : "#version 300 es");
}

Ui::~Ui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::draw_content(const std::function<void()>& content, GLuint framebuffer, Extent window) {
  const RefusalsOfEs guard;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  content();
  ImGui::Render();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, window.width, window.height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  ++drawn_;
}

bool Ui::wants_keys() const {
  return ImGui::GetIO().WantTextInput;
}

bool Ui::wants_pointer() const {
  return ImGui::GetIO().WantCaptureMouse;
}

void Ui::draw(const std::function<void()>& content, UiDrawing drawing, Screen& screen, Extent window) {
  if (drawing == UiDrawing::kOver) {
    draw_content(content, 0, window);
    layer_is_fresh_ = false;
    return;
  }
  const Screen::Layer layer = screen.layer(window);
  const bool again = drawing == UiDrawing::kEverySecond && layer_is_fresh_ && !layer.renewed;
  if (!again) {
    screen.clear_layer();
    draw_content(content, layer.framebuffer, window);
  }
  layer_is_fresh_ = !again;
  screen.lay_over(window);
}

}  // namespace quincunx::scenes
