// SPDX-License-Identifier: MIT
// Only depth is wanted.

void main() {}
