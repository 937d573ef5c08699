"""The command of the wheel."""

import json
import signal
import subprocess
import sys
import time

import percuss


def test_the_command_answers_and_has_its_exit_codes(command):
    code, out, _ = command("systems", "--format", "csv")
    assert code == 0 and out.startswith("name,states,modes,events,trouble,source\n")
    code, out, err = command("events", "no-such-system", "--until", "1")
    assert code == 2 and out == "" and "no-such-system" in err
    assert command("--version")[1].split()[1] == percuss.__version__


def test_what_is_printed_is_whole(command):
    rows = command("events", "bouncing-ball", "--until", "2.5", "--format", "json")[1]
    assert [row["event"] for row in json.loads(rows)["rows"]] == ["", "impact", "impact", "end"]


def test_ctrl_c_ends_the_command():
    words = [sys.executable, "-m", "percuss", "--quiet", "lyapunov"]
    words += ["--transient", "0", "--periods", "1000000000"]
    work = subprocess.Popen(words, stderr=subprocess.DEVNULL)
    # Long enough for the interpreter to begin; the work itself would last for hours.
    time.sleep(1.5)
    work.send_signal(signal.SIGINT)
    assert work.wait(timeout=60) != 0
