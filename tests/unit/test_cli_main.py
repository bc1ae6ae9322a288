import pytest

from reduction.cli import main as module


def test_an_interrupt_before_a_command_has_begun_ends_in_words(monkeypatch, capsys):
    def interrupted(*words, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(module.Commands, "main", interrupted)
    with pytest.raises(SystemExit) as ended:
        module.app(["run", "campaign.toml"])
    assert ended.value.code == 130
    assert capsys.readouterr().err == "interrupted\n"
