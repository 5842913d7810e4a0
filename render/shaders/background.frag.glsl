// SPDX-License-Identifier: MIT
// A light gradient from bottom to top.

layout(location = 0) out vec4 colour;

void main() { colour = vec4(background(gl_FragCoord.y / viewport.y), 1.0); }
