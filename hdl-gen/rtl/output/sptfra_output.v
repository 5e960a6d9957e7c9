// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Output packet of a frame: sixteen words of its summary, with FIELD then f_x, f_y, f_z of each taxel, float32.
//
// | word    | content                                                                      |
// |---------|------------------------------------------------------------------------------|
// | 0       | status bits 15:0, frame counter 31:16                                        |
// | 1       | timestamp                                                                    |
// | 2 to 4  | F_x, F_y, F_z in N                                                           |
// | 5 to 7  | T_x, T_y, T_z in N m                                                         |
// | 8, 9    | mu, phi in rad                                                               |
// | 10, 11  | mu_x, mu_y                                                                   |
// | 12      | standard error of (F_x, F_y) in N                                            |
// | 13      | contacts in bits 7:0, version of the calibration 15:8, replaced taxels 23:16 |
// | 14, 15  | 0                                                                            |
//
// One beat of WORDS words a cycle while the sink takes them, the first word in the lowest bits. The first beat comes
// 13 cycles after start. Frames without an answer send zeros but for words 0, 1 and 13. Zeros fill the last beat.
// Taxels' forces come from the field memory as they go out. Names end in the cycles since the beat was issued.

`default_nettype none

module sptfra_output #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // 1: the forces of all taxels go out too; 0: resultants only
    parameter integer FIELD = 1,
    // A step of a force is 2^FORCE_LSB N, of a torque 2^TORQUE_LSB N m, of a taxel's force 2^FIELD_LSB N
    parameter integer FORCE_LSB = -50,
    parameter integer TORQUE_LSB = -55,
    parameter integer FIELD_LSB = -50,
    // 32-bit words of a beat: 1, 2 or 4
    parameter integer WORDS = 1,
    // Enabled cycles from a step of the field memory to the forces
    parameter integer FIELD_STAGES = 6,
    // From start to the first beat, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // Start, with timestamp, counters and exponent; all else but the field holds for a cycle more
    input  wire start,
    output wire idle,
    input  wire [15:0] status,
    input  wire [31:0] timestamp,
    input  wire [31:0] counters, // word 13
    input  wire [4:0] exponent, // of the frame's scale: forces, torques and error are divided by two to its power
    input  wire blank, // no answer: zeros
    input  wire [6*64-1:0] wrench, // forces in x, y, z, torques in x, y, z, the first in the lowest bits
    input  wire [63:0] friction_quotient,
    input  wire signed [9:0] friction_exponent,
    input  wire signed [31:0] angle, // 29 fraction bits
    input  wire [63:0] error_value, // standard error, in steps of a force times 2^error_exponent
    input  wire signed [9:0] error_exponent,
    input  wire signed [17:0] mu_x, // 16 fraction bits
    input  wire signed [17:0] mu_y,
    // Field memory: after rewind, the first beat's forces; after each step, the next ones
    output reg  signed [17:0] field_mu_x, // of the frame going out
    output reg  signed [17:0] field_mu_y,
    output wire field_enable,
    output wire field_rewind,
    output wire field_step,
    output reg  field_release,
    input  wire [64*WORDS-1:0] field_value, // FIELD_STAGES + 1 enabled cycles after their step
    // Stream out
    output wire [32*WORDS-1:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    localparam integer SUMMARY_BEATS = 16 / WORDS;
    localparam integer SUMMARY_WIDTH = $clog2(SUMMARY_BEATS);
    localparam integer WORD_WIDTH = $clog2(WORDS);
    localparam integer FIELD_WORDS = 3 * COLUMNS * ROWS;
    localparam integer FIELD_BEATS = (FIELD_WORDS + WORDS - 1) / WORDS;
    localparam integer BEATS = (FIELD != 0) ? SUMMARY_BEATS + FIELD_BEATS : SUMMARY_BEATS;
    localparam integer BEAT_WIDTH = $clog2(BEATS);
    localparam integer LAST_BEAT = BEATS - 1;
    localparam integer REMAINDER = FIELD_WORDS - (FIELD_BEATS - 1) * WORDS; // words of the field's last beat
    // The beat before the first one that steps the field memory: its forces arrive at the end of stage 3
    localparam integer BEFORE_READ = SUMMARY_BEATS + 3 - FIELD_STAGES;
    localparam [SUMMARY_WIDTH-1:0] BEFORE_READ_BEAT = BEFORE_READ[SUMMARY_WIDTH-1:0];

    if ((WORDS != 1) && (WORDS != 2) && (WORDS != 4)) begin : gen_check_words
        sptfra_error_words_of_a_beat_must_be_1_2_or_4 invalid ();
    end

    // ---- The frame, held
    reg busy;
    reg load; // a cycle after its start
    reg [15:0] frame_count;
    reg [15:0] held_status;
    reg [31:0] held_timestamp;
    reg [31:0] held_counters;
    reg [4:0] held_scale;
    reg held_blank;
    reg [6*64-1:0] held_wrench;
    reg [63:0] held_quotient;
    reg signed [9:0] held_exponent;
    reg signed [31:0] held_angle;
    reg [63:0] held_error;
    reg signed [9:0] held_error_exponent;

    // The beat, one cycle after it is asked of the field memory: index k is k cycles after that
    reg issued;
    reg issued_last;
    reg [BEAT_WIDTH-1:0] issued_beat;
    reg [11:1] valid;
    reg [11:1] lasts;
    reg [11:1] statuses; // the beat with the status
    reg [3:1] blanks;
    reg [3:1] in_field;
    reg [SUMMARY_WIDTH-1:0] beat_1; // of the summary
    reg [SUMMARY_WIDTH-1:0] beat_2;
    reg [15:0] frame_1;
    reg [15:0] frame_2;

    reg [BEAT_WIDTH-1:0] beat;
    wire advance = m_tready; // of the skid buffer, a register
    reg reads; // the field memory, some beats ahead
    wire last_beat = (beat == LAST_BEAT[BEAT_WIDTH-1:0]);
    wire beat_in_field;

    if (FIELD != 0) begin : gen_field
        assign beat_in_field = (issued_beat[BEAT_WIDTH-1:SUMMARY_WIDTH] != {(BEAT_WIDTH - SUMMARY_WIDTH){1'b0}});
    end else begin : gen_summary
        assign beat_in_field = 1'b0;
    end

    assign idle = !busy && !issued && !valid[1] && !valid[2]; // the last beat no longer needs what is held
    assign field_enable = advance;
    assign field_rewind = start;
    assign field_step = busy && advance && reads;

    always @(posedge clock) begin
        field_release <= 1'b0;
        if (busy && advance) begin
            beat <= beat + 1'b1;
            reads <= reads || (beat[SUMMARY_WIDTH-1:0] == BEFORE_READ_BEAT);
            if (last_beat) begin
                busy <= 1'b0;
                frame_count <= frame_count + 16'd1;
            end
        end
        // The last component must have left the memory before its place is given back
        if (issued && issued_last && advance) begin
            field_release <= 1'b1;
        end
        if (start) begin
            busy <= 1'b1;
            beat <= {BEAT_WIDTH{1'b0}};
            reads <= 1'b0;
            held_timestamp <= timestamp;
            held_counters <= counters;
            held_scale <= exponent;
        end
        // The many bits follow the decision through a register; the first beat needs them a cycle later
        load <= start;
        if (load) begin
            held_status <= status;
            held_blank <= blank;
            held_wrench <= wrench;
            held_quotient <= friction_quotient;
            held_exponent <= friction_exponent;
            held_angle <= angle;
            held_error <= error_value;
            held_error_exponent <= error_exponent;
            field_mu_x <= mu_x;
            field_mu_y <= mu_y;
        end
        if (reset) begin
            busy <= 1'b0;
            load <= 1'b0;
            frame_count <= 16'd0;
            field_release <= 1'b0;
        end
    end

    // ---- Stages 1 to 3: which words, of which frame
    always @(posedge clock) begin
        if (advance) begin
            issued <= busy;
            issued_last <= last_beat;
            issued_beat <= beat;
            valid <= {valid[10:1], issued};
            lasts <= {lasts[10:1], issued_last};
            statuses <= {statuses[10:1], issued_beat == {BEAT_WIDTH{1'b0}}};
            in_field <= {in_field[2:1], beat_in_field};
            blanks <= {blanks[2:1], held_blank};
            beat_1 <= issued_beat[SUMMARY_WIDTH-1:0];
            beat_2 <= beat_1;
            frame_1 <= frame_count;
            frame_2 <= frame_1;
        end
        if (reset) begin
            issued <= 1'b0;
            valid <= 11'd0;
        end
    end

    // ---- Stages 3 and 4: the words of a beat, from the summary, or from the field in stage 4
    localparam signed [9:0] FORCE_EXPONENT = FORCE_LSB[9:0];
    localparam signed [9:0] TORQUE_EXPONENT = TORQUE_LSB[9:0];
    localparam signed [9:0] FIELD_EXPONENT = FIELD_LSB[9:0];
    localparam signed [9:0] FRICTION_EXPONENT = -10'sd16;
    localparam signed [9:0] ANGLE_EXPONENT = -10'sd29;
    wire signed [9:0] scale_exponent = $signed({5'd0, held_scale});
    genvar index;

    for (index = 0; index < WORDS; index = index + 1) begin : gen_words
        localparam [3:0] PLACE = index;
        wire [31:0] word_wide_2 = {{(32-SUMMARY_WIDTH){1'b0}}, beat_2} << WORD_WIDTH;
        wire [3:0] word_2 = word_wide_2[3:0] | PLACE;
        wire signed [63:0] force_3 = $signed(field_value[64*index +: 64]);
        wire behind_3 = (index >= REMAINDER) && lasts[3]; // the frame's last word: 0
        wire _unused_word = &{1'b0, word_wide_2};
        reg [3:0] word_3;
        reg signed [63:0] summary_3;
        reg signed [9:0] summary_exponent_3;
        reg signed [9:0] field_exponent_3; // the next frame may be held while a last word is here
        reg signed [63:0] value_4;
        reg signed [9:0] exponent_4;
        reg [11:4] raws; // words that are no float32
        wire raw_3 = !in_field[3] && ((word_3 == 4'd0) || (word_3 == 4'd1) || (word_3 == 4'd13));

        always @(posedge clock) begin
            if (advance) begin
                raws <= {raws[10:4], raw_3};
                // Stage 3
                word_3 <= word_2;
                field_exponent_3 <= FIELD_EXPONENT - scale_exponent;
                summary_exponent_3 <= FORCE_EXPONENT - scale_exponent;
                case (word_2)
                    4'd0: summary_3 <= {32'd0, frame_2, held_status};
                    4'd1: summary_3 <= {32'd0, held_timestamp};
                    4'd2: summary_3 <= held_wrench[64*0 +: 64];
                    4'd3: summary_3 <= held_wrench[64*1 +: 64];
                    4'd4: summary_3 <= held_wrench[64*2 +: 64];
                    4'd5: begin
                        summary_3 <= held_wrench[64*3 +: 64];
                        summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                    end
                    4'd6: begin
                        summary_3 <= held_wrench[64*4 +: 64];
                        summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                    end
                    4'd7: begin
                        summary_3 <= held_wrench[64*5 +: 64];
                        summary_exponent_3 <= TORQUE_EXPONENT - scale_exponent;
                    end
                    4'd8: begin
                        summary_3 <= held_quotient;
                        summary_exponent_3 <= held_exponent;
                    end
                    4'd9: begin
                        summary_3 <= { {32{held_angle[31]}}, held_angle};
                        summary_exponent_3 <= ANGLE_EXPONENT;
                    end
                    4'd10: begin
                        summary_3 <= { {46{field_mu_x[17]}}, field_mu_x};
                        summary_exponent_3 <= FRICTION_EXPONENT;
                    end
                    4'd11: begin
                        summary_3 <= { {46{field_mu_y[17]}}, field_mu_y};
                        summary_exponent_3 <= FRICTION_EXPONENT;
                    end
                    4'd12: begin
                        summary_3 <= held_error;
                        summary_exponent_3 <= held_error_exponent + FORCE_EXPONENT - scale_exponent;
                    end
                    4'd13: summary_3 <= {32'd0, held_counters};
                    default: summary_3 <= 64'sd0;
                endcase
                // Stage 4
                if (in_field[3]) begin
                    value_4 <= (blanks[3] || behind_3) ? 64'sd0 : force_3;
                    exponent_4 <= field_exponent_3;
                end else begin
                    value_4 <= (blanks[3] && !raw_3) ? 64'sd0 : summary_3;
                    exponent_4 <= summary_exponent_3;
                end
            end
        end

        // Stages 5 to 11: float32; words that are none pass beside it
        wire [31:0] float_word;
        reg [7*32-1:0] raw_words; // of stages 11 to 5

        sptfra_fixed_to_float fixed_to_float (
            .clock      (clock),
            .enable     (advance),
            .fixed      (value_4),
            .exponent   (exponent_4),
            .float_bits (float_word)
        );

        always @(posedge clock) begin
            if (advance) begin
                raw_words <= {raw_words[6*32-1:0], value_4[31:0]};
            end
        end

        assign m_tdata[32*index +: 32] = raws[11] ? raw_words[7*32-1 -: 32] : float_word;
    end

    assign m_tlast = lasts[11];
    assign m_tvalid = valid[11];

`ifdef SIMULATION
    // With a sink that stalls it takes longer; after one that has, beats of the frame before may still be on their way
    reg stalled;

    always @(posedge clock) begin
        stalled <= !advance || (start ? (valid != 11'd0) : stalled);
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset || stalled || !advance),
        .start (start),
        .done  (m_tvalid && statuses[11]) // the status goes first; beats of the frame before may still be on their way
    );
`else
    wire _unused_check = &{1'b0, EXPECTED_LATENCY != 0, statuses[11]};
`endif

endmodule

`default_nettype wire
