// SPDX-License-Identifier: MIT
// Cuts the disc out of its square.

layout(location = 0) in vec2 disc;

void main()
{
    if (dot(disc, disc) > 1.0) discard;
}
