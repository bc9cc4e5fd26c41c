# Completion of `foldproof` for bash:  source scripts/completion.bash   (an installed one is found by bash itself)
# Commands and options are what `foldproof COMMAND --help` shows, names what `foldproof list` shows; case files end in
# .toml, meshes in .obj, runs in .h5, tables in .csv.

# The words of a help text that can be typed: commands, or options.
_foldproof_commands() { "$1" --help | sed -n '/^Commands:/,/^$/ s/^  \([a-z]\+\) .*/\1/p'; }
_foldproof_options() { "$@" --help 2>/dev/null | sed -n 's/^  \(-., \)\?\(--[a-z-]*\).*/\2/p' | sort -u; }

# Names that `list` shows of some kinds, and the groups before the dots.
_foldproof_names() {
  local program=$1 kind
  shift
  for kind; do "$program" list "$kind"; done |
    awk '{ print $1; if (split($1, part, ".") > 1) print part[1] }' | sort -u
}

_foldproof_cases() { "$1" list cases; }

# Their findings: case.twist for hard/twist.
_foldproof_case_findings() { _foldproof_cases "$1" | sed 's|.*/||; s|^|case.|'; }

_foldproof_kind() {
  case $1 in
    simulate | settle | ablate | converge | precision | campaign) echo toml ;;
    inspect) echo obj ;;
    project | film | export | compare) echo h5 ;;
    crossings) echo 'h5|obj' ;;
    evaluate) echo csv ;;
  esac
}

_foldproof() {
  local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} now=${COMP_WORDS[COMP_CWORD]} words='' kind
  if ((COMP_CWORD == 1)); then
    words=$(_foldproof_commands "$program")
  elif [[ $now == -* ]]; then
    words=$(_foldproof_options "$program" "$command")
  elif [[ $command == check ]]; then
    words="$(_foldproof_names "$program" checks studies) case $(_foldproof_case_findings "$program")"
  elif [[ $command == study ]]; then
    words=$(_foldproof_names "$program" studies)
  elif [[ $command == judge && ${COMP_WORDS[COMP_CWORD-1]} != --* ]]; then
    words=$(_foldproof_names "$program" laws)
  elif [[ $command == golden ]]; then
    words='bending springs integrator forecast friction projection sticking'
  elif [[ $command == evaluate && $COMP_CWORD == 2 ]]; then
    words='bending crossings'
  elif [[ $command == campaign && $COMP_CWORD == 2 ]]; then
    words='plan run table report status watch cancel emit work'
  else
    kind=$(_foldproof_kind "$command")
    [[ $kind == toml ]] && words=$(_foldproof_cases "$program")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$now")
  if [[ -n $kind ]]; then
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(shopt -s extglob
      compgen -f -X "!*.@($kind)" -- "$now"
      compgen -d -S / -- "$now")
  elif [[ ($command == report || $command == history) && $now != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -d -S / -- "$now")
  fi
}

complete -F _foldproof foldproof build/foldproof
