// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Executes the program of the records: which instruction, of which bodies, and its steps.
//
// An instruction has 27 bits: what to do (5), destination (7), first source (7), second source (7), whether that
// one's sign is left out (1). A place is of 3 bits and a word of 4. What to do with 00 on top takes the sources as
// they are, with 01 on top the float unit (its operation below), with 10 on top this module: 0: jump if fewer than so
// many bodies are kept, 1: next i, 2: next j, 3: begin with j behind i, 4: the end, 5: begin with j = 0, 6: next j, of
// all that have a record. A jump goes to the destination, whose highest bit is that of the first source's,
// and its number is the first source's word.
//
// Steps: first (the first source's address), second (the second one's; the first one's word is there), third (the
// second one's word is there), then the unit's time. What moves a word finishes with the second step, what chooses one
// with the third; jumps take three cycles, the end two. The next instruction's word is out of the ROM by then, but for
// the first one in the cycle after a reset: there is no start then.

`default_nettype none

module sptfra_records_control #(
    // Bodies that have a record
    parameter integer CONTACTS = 4,
    // Instructions
    parameter integer PROGRAM_LENGTH = 128,
    // Prefix of the file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // The program, a word a line
    parameter FILE = ""
) (
    input  wire clock,
    input  wire reset,
    input  wire start,              // while idle
    input  wire [3:0] kept,         // with start
    input  wire unit_done,
    output wire idle,
    output reg  done,               // one cycle, behind the last instruction
    output wire ending,             // the cycle before, the last one
    output reg  [26:0] instruction,
    output reg  [3:0] i,            // a body: 8 is the frame, as it is where one is kept
    output reg  [3:0] j,
    output wire first,              // the steps
    output wire third,
    output wire finish
);

    localparam integer ADDRESS_WIDTH = (PROGRAM_LENGTH > 2) ? $clog2(PROGRAM_LENGTH) : 1;
    localparam [2:0] IDLE = 3'd0, FIRST = 3'd1, SECOND = 3'd2, THIRD = 3'd3, UNIT = 3'd4;
    localparam [2:0] CHOOSE = 3'd4; // of what takes the sources as they are
    localparam [2:0] JUMP = 3'd0, NEXT_I = 3'd1, NEXT_J = 3'd2, PAIR = 3'd3, END = 3'd4; // of what is done here
    localparam [2:0] FIRST_LAST = 3'd5, NEXT_LAST = 3'd6;

    generate
        if ((PROGRAM_LENGTH < 2) || (PROGRAM_LENGTH > 256)) begin : gen_check
            sptfra_error_a_program_has_2_to_256_instructions invalid ();
        end
    endgenerate

    reg [2:0] state;
    reg [3:0] kept_held;
    reg [ADDRESS_WIDTH-1:0] next; // instruction
    wire [1:0] kind = instruction[26:25];
    wire [2:0] what = instruction[24:22];
    wire [7:0] target = {instruction[14], instruction[21:15]};
    wire [3:0] number = instruction[11:8];
    wire of_control = kind[1];
    wire of_unit = kind[0];
    wire [4:0] i_then = {1'b0, i} + {1'b0, number};
    wire [3:0] j_then = j + 4'd1;
    wire i_left = (i_then < {1'b0, kept_held});
    wire j_left = (j_then < kept_held);
    wire last_left = (j_then < CONTACTS[3:0]);
    wire jump = (what == JUMP) ? (kept_held < number) : (what == NEXT_I) ? i_left
        : ((what == NEXT_J) && j_left) || ((what == NEXT_LAST) && last_left);
    // A word is taken from the ROM
    wire fetch = idle || finish || (third && of_control);
    wire [26:0] word;

    assign idle = (state == IDLE);
    assign first = (state == FIRST);
    assign third = (state == THIRD);
    assign finish = ((state == SECOND) && !of_control && !of_unit && (what != CHOOSE))
        || (third && !of_control && !of_unit) || ((state == UNIT) && unit_done);
    assign ending = (state == SECOND) && of_control && (what == END);

    sptfra_rom #(
        .WIDTH         (27),
        .DEPTH         (PROGRAM_LENGTH),
        .ADDRESS_WIDTH (ADDRESS_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (FILE)
    ) program_rom (
        .clock   (clock),
        .enable  (1'b1),
        .address (next),
        .data    (word)
    );

    always @(posedge clock) begin
        done <= 1'b0;
        case (state)
            IDLE: begin
                if (start) begin
                    state <= FIRST;
                    kept_held <= kept;
                    i <= (kept == 4'd1) ? 4'd8 : 4'd0;
                end
            end
            FIRST: begin
                state <= SECOND;
                if (of_control) begin
                    if (jump) begin
                        next <= target[ADDRESS_WIDTH-1:0];
                    end
                    if (what == END) begin
                        next <= {ADDRESS_WIDTH{1'b0}};
                    end
                    if (what == NEXT_I) begin
                        i <= i_left ? i + 4'd1 : 4'd0;
                    end
                    if ((what == NEXT_J) || (what == NEXT_LAST)) begin
                        j <= j_then;
                    end
                    if (what == PAIR) begin
                        j <= i + 4'd1;
                    end
                    if (what == FIRST_LAST) begin
                        j <= 4'd0;
                    end
                end
            end
            SECOND: state <= finish ? FIRST : THIRD;
            THIRD: state <= of_unit ? UNIT : FIRST;
            default: begin
                if (unit_done) begin
                    state <= FIRST;
                end
            end
        endcase
        if (fetch) begin
            instruction <= word;
        end
        if (fetch && (!idle || start)) begin
            next <= next + 1'b1;
        end
        if (ending) begin
            state <= IDLE;
            done <= 1'b1;
        end
        if (reset) begin
            state <= IDLE;
            next <= {ADDRESS_WIDTH{1'b0}};
            done <= 1'b0;
        end
    end

    wire _unused = &{1'b0, target, instruction[13:12], instruction[7:0]};

endmodule

`default_nettype wire
