// SPDX-License-Identifier: MIT
// Thin dark lines.

layout(location = 0) out vec4 colour;

void main() { colour = vec4(0.02, 0.02, 0.05, 0.8); }
