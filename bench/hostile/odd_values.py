"""Values that nobody expects, for all kinds of inputs."""

CONTROL = "\x1b]0;title\x07\x1b[2J\x1b[31mred\x9b1m\u202eback\r\nline"
TEXTS = ("", " ", "\t", "x", "x" * 300, "x" * 20_000, CONTROL, "[red]x[/][/", "<b onload=x>", "ö\u0301\u200b", "\udcff",
         "%s%n{0}", "$(x)`x`", "null", "~", "../../x", "-", "--", "'", '"')  # fmt: skip
NUMBERS = ("0", "-0.0", "-1", "1e-320", "1e308", "-1e308", "1e400", "nan", "-nan", "inf", "-inf", ".nan", ".inf",
           "0x10", "0o7", "1_0", "1:30", "1,5", "٣", "1e", "+", "9" * 19, "-" + "9" * 30, "9" * 5000, "1.0", "1",
           "true", "1 2", "1;2")  # fmt: skip
PLACES = ("nowhere", "nowhere/below", "/dev/null/x", "/dev/zero", "/dev/null", "/proc/self/mem", "/etc/shadow/x", "/",
          ".", "..", "x" * 300, "/".join(["x" * 200] * 30), CONTROL, "\udcff", "[red]x[/][/", "~", "file:///x", "-x",
          "")  # fmt: skip
LAWS = ("skyhook ", "SKYHOOK", ":", "x:", ":x", "os:", "os:path", "math:pi", "builtins:object", ".x:y", "..:x",
        "a.b.c:d.e", "a:b:c", "trackvib_sim.cli:main", "mr_mount_controller.laws.base:ControlLaw",
        "mr_mount_controller.laws.base:Sample")  # fmt: skip
