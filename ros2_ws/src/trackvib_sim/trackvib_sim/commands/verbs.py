"""A group of verbs on the command line."""

import click

_WHOLE = 1000  # characters of a sentence that says what a verb does


class Verbs(click.Group):
    """Lists its verbs with whole sentences; click's own list cuts them at the width of the terminal."""

    def format_commands(self, ctx, formatter):
        """Write the list, each sentence folded."""
        verbs = ((name, self.get_command(ctx, name)) for name in self.list_commands(ctx))
        with formatter.section("Commands"):
            formatter.write_dl([(name, verb.get_short_help_str(_WHOLE)) for name, verb in verbs])
