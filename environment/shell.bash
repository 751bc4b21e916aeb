# Start-up file of `./trackvib shell`: the user's own, but what it changes of the environment is put back.
_trackvib_environment=$(export -p)
if [ -f ~/.bashrc ]; then . ~/.bashrc; fi
eval "$_trackvib_environment"
unset _trackvib_environment
PS1="(trackvib) $PS1"
