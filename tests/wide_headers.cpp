// Nothing of its own: the headers that many tests include are precompiled with this file, once for all of them.
int main() {}
