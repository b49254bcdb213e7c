/* completion.c: scripts by which shells complete command lines, from the tables of options. What
 * has no list of words is completed as a file. */
#include <stdio.h>
#include <string.h>
#include "line/completion.h"

/* Print text with a backslash before each of some characters, for between single quotes. */
static void print_escaped(const char *text, size_t length, const char *special)
{
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\'') {
            fputs("'\\''", stdout);
            continue;
        }
        if (strchr(special, text[i]))
            putchar('\\');
        putchar(text[i]);
    }
}

/* Print the line of --help, or else the first words of the whole help. */
static void print_about(const struct option *option, const char *special)
{
    const char *text = option->brief ? option->brief : option->help;

    print_escaped(text, option->brief ? strlen(text) : strcspn(text, ";("), special);
}

static bool is_number(const struct option *option)
{
    return option->kind == OPTION_NUMBER || option->kind == OPTION_INTEGER ||
           option->kind == OPTION_NUMBERS;
}

static bool has_words(const struct option *option)
{
    return options_word(option, 0) || option->word;
}

/* "sweep search ..." */
static void print_words(const struct option *option)
{
    const char *before = "";

    for (uint32_t i = 0; options_word(option, i); i++, before = " ")
        printf("%s%s", before, options_word(option, i));
    if (option->word)
        printf("%s%s", before, option->word);
    if (option->other_word)
        printf(" %s", option->other_word);
}

static void print_subcommands(const struct command *const *commands)
{
    for (int i = 0; commands[i]; i++)
        printf("%s%s", i > 0 ? " " : "", commands[i]->name);
}

static void print_bash_command(const struct command *command)
{
    printf("    '%s '*) options='", command->name);
    for (const struct option *option = options_of(command); option->help; option++)
        if (option->kind != OPTION_HEADING)
            printf("%s ", option->name);
    puts("--help --help-all' ;;");
}

static void print_bash_words(const struct command *command)
{
    for (const struct option *option = options_of(command); option->help; option++) {
        if (option->kind == OPTION_HEADING || !has_words(option))
            continue;
        printf("    '%s %s') words='", command->name, option->name);
        print_words(option);
        puts("' ;;");
    }
}

/* Bash takes "--name=value" for three words. */
static void print_bash(const struct command *const *commands, const char *const *words)
{
    puts("# bash completion of refocus\n"
         "_refocus()\n{\n"
         "    local cur=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "    local command=${COMP_WORDS[1]} words= options=\n\n"
         "    if [ \"$cur\" = = ]; then cur=\n"
         "    elif [ \"$option\" = = ]; then option=${COMP_WORDS[COMP_CWORD - 2]}\n"
         "    fi\n"
         "    case \"$command \" in");
    for (int i = 0; commands[i]; i++)
        print_bash_command(commands[i]);
    puts("    esac\n    case \"$command $option\" in");
    for (int i = 0; commands[i]; i++)
        print_bash_words(commands[i]);
    printf("    'help help' | 'man man') words='");
    print_subcommands(commands);
    printf("' ;;\n    'completion completion') words='bash zsh fish' ;;\n    esac\n"
           "    if [ \"$COMP_CWORD\" -eq 1 ]; then words='");
    print_subcommands(commands);
    for (int i = 0; words[i]; i++)
        printf(" %s", words[i]);
    puts("'\n    elif [ -z \"$words\" ] && [ \"${cur#-}\" != \"$cur\" ]; then words=$options\n"
         "    fi\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
         "}\ncomplete -o bashdefault -o default -F _refocus refocus");
}

static void print_zsh_option(const struct option *option)
{
    static const char special[] = "[]:\\";

    if (option->letter)
        printf("        '(-%c %s)'{-%c+,%s=}'[", option->letter, option->name, option->letter,
               option->name);
    else
        printf("        '%s%s[", option->name, option->kind == OPTION_FLAG ? "" : "=");
    print_about(option, special);
    putchar(']');
    if (option->argument) {
        putchar(':');
        print_escaped(option->argument, strlen(option->argument), special);
        if (has_words(option)) {
            fputs(":(", stdout);
            print_words(option);
            putchar(')');
        } else {
            fputs(is_number(option) ? ": " : ":_files", stdout);
        }
    }
    puts("' \\");
}

static void print_zsh(const struct command *const *commands, const char *const *words)
{
    puts(
        "#compdef refocus\n# zsh completion of refocus\n_refocus()\n{\n    local -a subcommands\n\n"
        "    subcommands=(");
    for (int i = 0; commands[i]; i++) {
        printf("        '%s:", commands[i]->name);
        print_escaped(commands[i]->summary, strlen(commands[i]->summary), "\\");
        puts("'");
    }
    for (int i = 0; words[i]; i++)
        printf("        %s\n", words[i]);
    puts("    )\n    if ((CURRENT == 2)); then\n        _describe subcommand subcommands\n"
         "        return\n    fi\n    shift words\n    ((CURRENT--))\n    case $words[1] in");
    for (int i = 0; commands[i]; i++) {
        printf("    %s)\n        _arguments \\\n", commands[i]->name);
        for (const struct option *option = options_of(commands[i]); option->help; option++)
            if (option->kind != OPTION_HEADING)
                print_zsh_option(option);
        puts("        '(-h --help)'{-h,--help}'[the options that most need]' \\\n"
             "        '--help-all[all options]' \\\n        '*:file:_files' ;;");
    }
    printf("    help | man) compadd ");
    print_subcommands(commands);
    puts(" ;;\n    completion) compadd bash zsh fish ;;\n    esac\n}\n"
         "if [ \"$funcstack[1]\" = _refocus ]; then _refocus \"$@\"; else compdef _refocus "
         "refocus; fi");
}

static void print_fish_option(const struct command *command, const struct option *option)
{
    printf("complete -c refocus -n '__fish_seen_subcommand_from %s'", command->name);
    if (option->letter)
        printf(" -s %c", option->letter);
    printf(" -l %s", option->name + 2);
    if (option->kind != OPTION_FLAG)
        fputs(option->kind == OPTION_TEXT ? " -r" : " -x", stdout);
    if (has_words(option)) {
        fputs(" -a '", stdout);
        print_words(option);
        putchar('\'');
    }
    fputs(" -d '", stdout);
    print_about(option, "\\");
    puts("'");
}

static void print_fish_subcommand(const char *name, const char *about)
{
    printf("complete -c refocus -n __fish_use_subcommand -f -a %s -d '", name);
    print_escaped(about, strlen(about), "\\");
    puts("'");
}

static void print_fish(const struct command *const *commands, const char *const *words)
{
    puts("# fish completion of refocus");
    for (int i = 0; commands[i]; i++)
        print_fish_subcommand(commands[i]->name, commands[i]->summary);
    for (int i = 0; words[i]; i++)
        print_fish_subcommand(words[i], "");
    printf("complete -c refocus -n '__fish_seen_subcommand_from help man' -f -a '");
    print_subcommands(commands);
    puts(
        "'\ncomplete -c refocus -n '__fish_seen_subcommand_from completion' -f -a 'bash zsh fish'");
    for (int i = 0; commands[i]; i++) {
        for (const struct option *option = options_of(commands[i]); option->help; option++)
            if (option->kind != OPTION_HEADING)
                print_fish_option(commands[i], option);
        printf("complete -c refocus -n '__fish_seen_subcommand_from %s' -s h -l help -d 'the "
               "options that most need'\n"
               "complete -c refocus -n '__fish_seen_subcommand_from %s' -l help-all -d 'all "
               "options'\n",
               commands[i]->name, commands[i]->name);
    }
}

bool completion_print(const char *shell, const struct command *const *commands,
                      const char *const *words)
{
    static const struct {
        const char *name;
        void (*print)(const struct command *const *commands, const char *const *words);
    } shells[] = {{"bash", print_bash}, {"zsh", print_zsh}, {"fish", print_fish}};

    for (size_t i = 0; i < sizeof shells / sizeof *shells; i++)
        if (strcmp(shell, shells[i].name) == 0) {
            shells[i].print(commands, words);
            return true;
        }
    return false;
}
