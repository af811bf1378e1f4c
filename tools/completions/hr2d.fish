# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of hr2d for fish: commands and options are those that its help lists.
function __hr2d_commands
    command hr2d help 2>/dev/null | string replace -rf '^  hr2d ([a-z]+) +(?:SCENE|< PAIRS|\[NAME\]) +(.*)' '$1\t$2'
    printf 'help\toptions of a command\n'
end
function __hr2d_options
    set -l words (commandline -opc)
    command hr2d help $words[2] 2>/dev/null |
        string replace -rf '^  (--[a-z0-9-]+)(?: [A-Z][^ ]*)? +(.*)' '$1\t$2'
end
complete -c hr2d -n 'test (count (commandline -opc)) -eq 1' -f -a '(__hr2d_commands)'
complete -c hr2d -n 'string match -q -- "help" (commandline -opc)[2]' -f -a '(__hr2d_commands)'
complete -c hr2d -n 'test (count (commandline -opc)) -gt 1' -a '(__hr2d_options)'
