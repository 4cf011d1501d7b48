// nothing.frag: depth only.
void main() {}
