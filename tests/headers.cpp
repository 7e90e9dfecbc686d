// Nothing of its own: the headers that every test includes are compiled with this, once for all of
// them.
int main() { return 0; }
