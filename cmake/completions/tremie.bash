# Completion of tremie for bash. Commands and options are asked of the program: what it says is what there is.
_tremie() {
  local cur prev words cword
  _init_completion || return
  local program=${words[0]} command=${words[1]}
  if ((cword == 1)); then
    COMPREPLY=($(compgen -W "$("$program" --commands 2>/dev/null | cut -f1) --help --version" -- "$cur"))
  elif [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$("$program" "$command" --help 2>/dev/null | sed -nE 's/^  (-.,)?(--[a-z0-9-]+).*/\2/p')" -- "$cur"))
  else
    _filedir
  fi
}
complete -F _tremie tremie
