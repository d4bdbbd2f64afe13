# zsh -f zsh_completion.zsh <folder of the completions> (<typed> <wanted>)...
# Types into a shell on a pseudo terminal, presses the tabulator and waits until what is wanted appears.
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PS1=; fpath=(${(q)1} \$fpath); autoload -Uz compinit; compinit -u -D; setopt nobeep"
zpty -w shell 'print READY-$((40 + 2))'
zpty -r shell out '*READY-42*' || exit 9
shift
for typed wanted; do
  zpty -w -n shell $'\x15'$typed$'\t' # first empties the line
  zpty -r shell out "*$wanted*" || exit 8
  print -r -- $wanted
done
zpty -d shell
