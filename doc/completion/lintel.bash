# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2207 # words of completions hold no spaces, except file names, which are read by lines
# Bash completion of all of Lintel's programs. Options and their values come from `PROGRAM --help`, the keys of --set from
# `lintel-vio --dump-config`: what a program learns is completed without a change here.

# The line of --help that describes option $2 of program $1, without its text.
_lintel_option() {
    "$1" --help 2>/dev/null | sed -n "s/^  //; /^[^ ]*$2\([, ]\|$\)/{s/   *.*//; p; q}"
}

# dotted keys with their values, as --set takes them: estimator.keyframes=10
_lintel_settings() {
    "$1" --dump-config 2>/dev/null | awk '
        { match($0, /^ */); depth = RLENGTH / 2; split($0, part, ":"); gsub(/ /, "", part[1]); path[depth] = part[1] }
        /: *[^ ]/ { key = path[0]; for (i = 1; i <= depth; ++i) key = key "." path[i]; print key "=" }'
}

# forms of export, as lintel-map ($1) lists them
_lintel_forms() {
    "$1" --help 2>/dev/null | sed -n 's/.*its extension chooses the form: //p'
}

# Names of files that match one of the extensions $2 ("*" for any), and folders.
_lintel_files() {
    local name IFS=$'\n'
    for name in $(compgen -d -- "$1"); do COMPREPLY+=("$name/"); done
    for name in $(compgen -f -- "$1"); do
        [[ -d $name ]] && continue
        [[ $2 == '*' || $name =~ \.($2)$ ]] && COMPREPLY+=("$name")
    done
    compopt -o filenames -o nospace 2>/dev/null
}

_lintel() {
    local program=$1 current=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]}
    local before=${COMP_WORDS[COMP_CWORD-2]-} described
    COMPREPLY=()
    # "=" is a word of its own to bash: --set key = value
    if [[ $option == '=' || ( $current == '=' && $before == --set ) ]]; then return; fi
    if [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$("$program" --help 2>/dev/null | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr ',' ' ')" -- "$current"))
        return
    fi
    if [[ $option == -* ]]; then
        described=$(_lintel_option "$program" "$option")
        case $described in
        *'{'*'}'*)
            described=${described#*\{}
            COMPREPLY=($(compgen -W "$(tr ',' ' ' <<<"${described%%\}*}")" -- "$current"))
            return ;;
        *KEY=VALUE*)
            COMPREPLY=($(compgen -W "$(_lintel_settings "$program")" -- "$current"))
            compopt -o nospace 2>/dev/null
            return ;;
        *EXT,*)
            COMPREPLY=($(compgen -W "none $(_lintel_forms "${program/%lintel-vio/lintel-map}")" -- "$current"))
            return ;;
        *.yaml*) _lintel_files "$current" 'yaml|yml'; return ;;
        *MAP.lintel*) _lintel_files "$current" 'lintel'; return ;;
        *' FOLDER'* | *' DIR'* | *' OUT') _lintel_files "$current" 'rawlog'; return ;;
        *' EST'* | *' GT'*) _lintel_files "$current" 'tum|txt|csv'; return ;;
        *' FILE'*) _lintel_files "$current" '*'; return ;;
        *' INT'* | *' UINT'* | *' FLOAT'*) return ;;
        *' '*) _lintel_files "$current" '*'; return ;;
        esac
    fi
    case $("$program" --help 2>/dev/null | sed -n '/^Positionals:/{n; p}') in
    *INPUT*) _lintel_files "$current" 'rawlog|bag|db3|mcap' ;;
    *MAP.lintel*) _lintel_files "$current" 'lintel' ;;
    *SUITE*) _lintel_files "$current" 'yaml|yml' ;;
    esac
}

complete -F _lintel lintel-vio lintel-map lintel-eval lintel-sim lintel-bench euroc2rawlog
